// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// How right the ranges of one frame are.
struct RangeScore {
  double wrong_wrap_percent = 0;  ///< of the pixels with a range: off by more than λ_A / 2
  double coverage_percent = 0;    ///< of the pixels with a return and a known truth: have a range
  double range_rmse_m = 0;        ///< of those that are not wrong; NaN if there is none
};

/// Compares a range image with true radial ranges (metres, NaN unknown). Pixels that have no
/// return (reason no_return) or no truth do not count. Throws UsageError if sizes differ.
RangeScore score_ranges(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m);

/// Mean over frames; frames without an RMSE do not count for it.
RangeScore mean_score(const std::vector<RangeScore>& frames);

}  // namespace tofmap
