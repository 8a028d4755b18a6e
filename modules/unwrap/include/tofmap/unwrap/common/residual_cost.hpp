// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

/// The inter-frequency residual of one pixel for wrap count n_A: the range at A minus the nearest
/// range that B's phase allows; metres, −λ_B / 2 … λ_B / 2. It is near zero for the true wrap
/// count; NaN if a phase is NaN. B's wrap count is not limited: near both ends of the range limits,
/// noise may carry B across a wrap boundary that A has not crossed.
float count_residual_m(const PairLimits& limits, float phase_a, float phase_b, int n_a);

/// The largest phase of A, in cycles, at which the range for wrap count n_A is within the limits
/// (see count_within_limits); −1 if n_A is not in 0 … count_a − 1.
float farthest_phase_cycles(const PairLimits& limits, int n_a);

/// The smallest change of the residual by another wrap count within the limits, metres; the
/// function of this name in tofmap/core/frequency_residual.hpp has the definition.
double residual_step_m(const PairLimits& limits);

/// True if the wrap count n_A ≥ 0 gives a range at A of at most max_range_m plus λ_A / 20, a
/// tolerance for noise at the limit. Always true for n_A = 0.
bool count_within_limits(const PairLimits& limits, float phase_a, int n_a);

/// Equation 2 of Droeschel et al. 2010, extended to any number of wraps: the wrap count with the
/// smallest absolute residual in each pixel, within the limits; of equal ones the smallest wrap
/// count. invalid_wrap_count where either phase is NaN. For two wrap counts this is a threshold at
/// |λ_A − λ_B| / 2. threshold_counts() is the equation as the paper prints it.
ImageU8 nearest_pair_counts(const Frame& frame, const PairLimits& limits);

/// R̂ of equation 2: phase_a + n_A, cycles; NaN where the wrap count is invalid.
ImageF reconstruct_cycles(const ImageF& phase_a, const ImageU8& counts);

/// A pixel whose wrap count is known relative to that of its region.
struct CountedPixel {
  int pixel;   ///< index of the pixel, row by row
  int offset;  ///< wrap count of the pixel minus that of the region
};

/// How badly each wrap count fits the residual of each pixel, in nats: ρ² / 2σ², with the residual
/// ρ and its standard deviation σ (equation 10 of docs/unwrapping.md). The cost is bounded, so that
/// flying pixels and multipath cannot outvote a surface. Wrap counts outside the limits, and all
/// wrap counts of pixels without a return, have the cost `bound`.
class ResidualCost {
 public:
  ResidualCost() = default;

  /// `sigma` is the noise of both phases, `residual_sigma_m` the standard deviation of the residual
  /// besides noise.
  ResidualCost(const Frame& frame, const PairLimits& limits, const PhaseSigma& sigma,
               double residual_sigma_m = 0);

  /// The cost of wrap count n_A in a pixel, whose index counts row by row; 0 … bound. n_A may be
  /// any number.
  float operator()(Eigen::Index pixel, int n_a) const;

  /// For each wrap count n = −1 … size() − 2 of a region, adds the costs of its pixels to
  /// `costs[n + 1]`; the wrap count of a pixel is n + offset. `costs` has size() elements; each
  /// offset must be within −size() … size(). The range of n contains all wrap counts within the
  /// limits and at least one more at both ends.
  void add(std::span<const CountedPixel> pixels, std::span<float> costs) const;

  /// The number of wrap counts that add() evaluates.
  std::size_t size() const { return size_; }

  /// The probability of the given wrap count of each pixel by the pixel's own residual: exp(−cost),
  /// normalised over all wrap counts; 0 where the wrap count is invalid.
  ImageF probability(const ImageU8& counts) const;

  /// The largest cost, that of a residual of three standard deviations; nats.
  static constexpr float bound = 4.5F;

 private:
  int count_a_ = 0;
  std::size_t size_ = 0;
  ImageF phase_a_;
  ImageF residual_cycles_;    ///< residual for wrap count 0, cycles of B
  ImageF precision_;          ///< 1 / 2σ² of the residual, 1 / cycles²
  std::vector<float> shift_;  ///< change of the residual by wrap counts −1 − size() …, cycles
  std::vector<float> farthest_;  ///< farthest_phase_cycles() of the same wrap counts
};

}  // namespace tofmap
