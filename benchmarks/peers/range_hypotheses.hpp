// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/kde_unwrap.hpp"
#include "peers/wrap_triplets.hpp"

#include <array>
#include <cstdint>

namespace tofmap::peers {

inline constexpr int most_hypotheses = 3;

/// The hypotheses of all pixels. Images have `margin` more columns on both sides, whose weights are
/// zero, so that loops over neighbours need no limits.
struct RangeHypotheses {
  int count = 0;
  Eigen::Index margin = 0;
  /// Best first. In units of √2 h, so that the kernel is exp(−difference²). Never NaN.
  std::array<ImageF, most_hypotheses> range;
  std::array<ImageF, most_hypotheses> weight;  ///< 0 without a return
  /// Indices of the triplets, without margins.
  std::array<Image<std::int32_t>, most_hypotheses> triplet;
};

/// The likelihood of the hypotheses of each pixel of `phases`, which must be calibrated().
RangeHypotheses range_hypotheses(const ThreePhases& phases, const WrapTriplets& triplets,
                                 const KdeOptions& options);

}  // namespace tofmap::peers
