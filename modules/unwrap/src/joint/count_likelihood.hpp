// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

/// The arrays of CountLikelihood, with one number for each pixel of a block.
namespace count_likelihood {

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

}  // namespace count_likelihood

/// How likely wrap counts of single pixels are by their own phases at all frequencies, in frames of
/// at least two. Works on one block of pixels after another.
class CountLikelihood {
 public:
  using Block = count_likelihood::Block;

  /// References must outlive the object. `residual_sigma_m` is as in WrapCountModel::assign.
  CountLikelihood(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                  const std::vector<double>& residual_sigma_m, double outlier_share);

  /// Goes to a block of at most block_pixels pixels, which begins at `at`, row by row.
  void go_to(Eigen::Index at, int pixels);

  /// The wrap counts of the block with the smallest costs: the sums of the squared residuals of all
  /// frequencies over twice their variances, each bounded where an outlier is as likely.
  const count_likelihood::Candidates& find_candidates();

  /// Equation 11 for one wrap count of each pixel of the block. The nearest other wrap is left out,
  /// which matters only for residuals with a noise of half a cycle.
  void find(const Block& count, Block& likelihood);

 private:
  void load_frequency(std::size_t f, Eigen::Index at, count_likelihood::Measured& out) const;

  const Frame& frame_;
  const UnwrapLimits& limits_;
  const PhaseSigma& sigma_;
  const std::vector<double>& residual_sigma_m_;
  float outlier_share_;
  std::vector<std::size_t> order_;  ///< all frequencies but the first, by wavelength
  double farthest_cycles_;
  int pixels_ = 0;
  count_likelihood::Measured first_;
  std::vector<count_likelihood::Measured> others_;
  count_likelihood::Candidates candidates_;
  count_likelihood::Estimate estimate_;
};

}  // namespace tofmap
