// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

/// The arrays of CountCost, with one number for each pixel of a block.
namespace count_cost {

/// Few enough for the intermediate results of a block to stay in the first-level cache.
inline constexpr int block_pixels = 256;
using Block = std::array<float, block_pixels>;

/// The measurements of one frequency; without NaN.
struct Measured {
  Block phase;
  Block variance_m2;
  Block bound;  ///< largest cost of a residual to this frequency, nats
  float wavelength_m;
  float ratio;  ///< wavelength of the first frequency to this one
};

/// The ranges for one wrap count, as the frequencies so far estimate them.
struct Estimate {
  Block change_m;  ///< estimate minus the range of the first frequency
  Block variance_m2;
  Block cost;  ///< of the wrap count, nats
};

/// The two wrap counts that fit each pixel best.
struct Candidates {
  Block cost;  ///< nats
  Block count;
  Block next_cost;
  Block next_count;
};

}  // namespace count_cost

/// What wrap counts of single pixels cost by their own phases at all frequencies, in frames of at
/// least two: the sum of the squared residuals of the other frequencies over twice their variances,
/// each bounded where an outlier is as likely. exp(−cost) approximates equation 11. Works on one
/// block of pixels after another.
class CountCost {
 public:
  using Block = count_cost::Block;

  /// References must outlive the object. `residual_sigma_m` is as in WrapCountModel::assign;
  /// `mixed` is 1 in mixed pixels, whose residuals say next to nothing.
  CountCost(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
            const std::vector<double>& residual_sigma_m, double outlier_share,
            const ImageU8& mixed);

  /// Goes to a block of at most block_pixels pixels, which begins at `at`, row by row.
  void go_to(Eigen::Index at, int pixels);

  /// Goes to a block of at most block_pixels pixels anywhere in the image, given by their places
  /// row by row.
  void go_to(std::span<const int> places);

  /// The two wrap counts of each pixel of the block with the smallest costs.
  const count_cost::Candidates& find_candidates();

  /// The costs of all wrap counts.
  const std::vector<Block>& find_all();

  /// The costs that find_all() has found.
  const std::vector<Block>& all() const { return costs_; }

  /// The cost of one wrap count for each pixel of the block.
  const Block& find(const Block& count);

 private:
  void load_frequency(std::size_t f, const float* phase, const float* sigma_cycles,
                      count_cost::Measured& out) const;
  template <class Load>
  void go(int pixels, const std::uint8_t* mixed, const Load& load_measured);
  void find_estimate(int count);

  const Frame& frame_;
  const UnwrapLimits& limits_;
  const PhaseSigma& sigma_;
  const std::vector<double>& residual_sigma_m_;
  float outlier_share_;
  const ImageU8& mixed_;
  std::vector<std::size_t> order_;  ///< all frequencies but the first, by wavelength
  double farthest_cycles_;
  int pixels_ = 0;
  count_cost::Measured first_;
  std::vector<count_cost::Measured> others_;
  count_cost::Candidates candidates_;
  count_cost::Estimate estimate_{};
  Block shift_;               ///< change of a residual by the wrap count, cycles
  std::vector<Block> costs_;  ///< of each wrap count
};

}  // namespace tofmap
