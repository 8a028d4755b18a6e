// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// What bounds the wrap counts of a frame: count_a is the number of counts n_A = 0 … count_a − 1.
struct UnwrapLimits {
  double wavelength_a_m = 0;
  double wavelength_b_m = 0;
  double max_range_m = 0;
  int count_a = 0;

  double wavelength_ratio() const { return wavelength_a_m / wavelength_b_m; }
};

/// Limits for ranges up to `max_range_m`; 0 means the sensor's, and if that is 0 too, what the
/// pair can tell apart at a noise of 0.05 cycles (29 and 31 MHz: 72.4 m).
/// Throws UsageError if that takes more than 255 counts, which wrap images cannot hold.
UnwrapLimits unwrap_limits(const SensorModel& sensor, double max_range_m);

/// The residual: range at A minus the nearest range that B allows, metres, for one pixel and one
/// count n_A; at most λ_B / 2 in size, and near zero for the true count.
/// B's count is not bounded by itself: near both ends of the range noise may carry B across
/// a wrap boundary that A has not crossed.
float count_residual_m(const UnwrapLimits& limits, float phase_a, float phase_b, int n_a);

/// The phase of A up to which a count's range is within the limits, cycles; negative for a count
/// that is none.
float farthest_phase_cycles(const UnwrapLimits& limits, int n_a);

/// residual_step_m (tofmap/core/frequency_residual.hpp) among the counts within the limits.
double residual_step_m(const UnwrapLimits& limits);

/// True if the count puts A's range within 0 … max_range_m. A twentieth of a wavelength is
/// tolerated above for noise at the limit; count 0 is always within.
bool count_within_limits(const UnwrapLimits& limits, float phase_a, int n_a);

/// False if the residual of both counts is the same to a twentieth of a cycle of B: whole combined
/// ranges lie between them.
bool can_tell_apart(const UnwrapLimits& limits, int n_a, int other_n_a);

/// Equation 2 for any number of wraps: per pixel the n_A of the nearest pair, i.e. the least
/// |residual residual|; invalid_wrap_count where either phase is NaN. Equal residuals: the smaller.
/// For two counts it is a threshold at |λ_A − λ_B| / 2; the paper's own is threshold_counts.
ImageU8 nearest_pair_counts(const DualFrequencyFrame& frame, const UnwrapLimits& limits);

/// R̂ of equation 2: phase_a + n_A, cycles; NaN where the count is invalid.
ImageF reconstruct_cycles(const ImageF& phase_a, const ImageU8& counts);

/// A pixel, numbered row by row, whose count is that of something else plus an offset.
struct CountedPixel {
  int pixel;
  int offset;
};

/// How badly a count fits the residual of each pixel, in nats: half the squared residual over its
/// variance, bounded so that flying pixels and multipath cannot outvote a surface. Outside the
/// limits, and without a return, every count costs the bound.
class ResidualCost {
 public:
  ResidualCost() = default;
  /// `residual_sigma_m` is what the residual has besides the noise of both phases.
  ResidualCost(const DualFrequencyFrame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
               double residual_sigma_m = 0);

  /// The cost of n_A at a pixel, numbered row by row: 0 … bound. n_A is any count.
  float operator()(Eigen::Index pixel, int n_a) const;

  /// Adds costs of counts −1 … size() − 2: of all that are within the limits, and at least one more
  /// at both ends. The count of each pixel is n_A + offset, where −size() ≤ offset ≤ size().
  void add(std::span<const CountedPixel> pixels, std::span<float> costs) const;
  std::size_t size() const { return size_; }

  /// The likelihood of each pixel's count over the sum of all counts'; 0 where it is invalid.
  ImageF probability(const ImageU8& counts) const;

  static constexpr float bound = 4.5F;  ///< three standard deviations

 private:
  int count_a_ = 0;
  std::size_t size_ = 0;
  ImageF phase_a_;
  ImageF residual_cycles_;    ///< of count 0, in cycles of B
  ImageF precision_;          ///< half the inverse variance of the residual, 1 / cycles²
  std::vector<float> shift_;  ///< what counts from −1 − size() on add to the residual, cycles
  std::vector<float> farthest_;  ///< phase up to which their range is within the limits
};

}  // namespace tofmap
