// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid.hpp"

#include <array>
#include <vector>

namespace tofmap::accuracy {

/// What `joint` must keep to, on every row of the grid.
enum class Condition : std::uint8_t {
  no_worse_than_simple = 0,  ///< mean ≤ that of the better of pixel and jump
  mean_kept = 1,             ///< mean ≤ 1.3 times that without the errors
  worst_kept = 2,            ///< worst frame ≤ twice that without the errors
  surest_kept = 3,           ///< among the surest 90 % ≤ twice as many as without the errors
  calibrated = 4,            ///< calibration error ≤ 1 %
};
inline constexpr int condition_count = 5;

const char* name_of(Condition condition);

/// A condition on one row: `value` ≤ `limit` + `allowance`, in percent of the pixels.
///
/// The allowance is three standard errors of value − limit, the larger of two estimates:
/// - over frames: the standard deviation of the frames' differences over the root of their number.
///   Frames of one row show the same places with the same noise, so that they are compared one by
///   one. Consecutive frames are alike, which makes this estimate too small rather than too large;
/// - of counting: wrong wraps are counts of pixels, n of them have a standard error of √n (Poisson)
///   as if each pixel were wrong by itself. It matters where there are a few pixels.
/// If nothing separates the two, a row fails about once in 700 times. A worst frame has the second
/// alone, a calibration error the first alone: wrong wraps come as whole surfaces, so that frames
/// differ in the share of right ones by much more than pixels that are wrong by themselves would.
struct Check {
  bool applies = false;  ///< mean_kept, worst_kept and surest_kept: not in ambient light, nor
                         ///< where nothing is wrong
  double value = 0;
  double limit = 0;
  double allowance = 0;

  bool holds() const { return !applies || value <= limit + allowance; }

  /// By how much the value exceeds what is allowed; 0 or less if it holds.
  double excess() const { return applies ? value - limit - allowance : 0; }
};

using Checks = std::array<Check, condition_count>;  ///< in the order of Condition

Checks check_row(const Grid& grid, const GridRow& row);

}  // namespace tofmap::accuracy
