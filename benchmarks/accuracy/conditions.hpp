// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid.hpp"

#include <array>
#include <vector>

namespace tofmap::accuracy {

/// The conditions that `joint` must meet in every row of the grid. They compare its share of wrong
/// wraps.
enum class Condition : std::uint8_t {
  no_worse_than_simple = 0,  ///< mean ≤ mean of the better of pixel and jump
  mean_kept = 1,             ///< mean ≤ 1.3 times the mean without the errors
  worst_kept = 2,            ///< worst frame ≤ twice the worst frame without the errors
  surest_kept = 3,  ///< share among the most confident 90 % ≤ twice the share without the errors
  calibrated = 4,   ///< calibration error ≤ 1 %
};
inline constexpr int condition_count = 5;

/// The condition in words, for tables.
const char* name_of(Condition condition);

/// A condition on one row: `value` ≤ `limit` + `allowance`, in percent of the pixels.
///
/// The allowance is three standard errors of value − limit, the larger of two estimates:
/// - from frames: the standard deviation of the differences between frames, divided by the square
/// root of their number. Frames are compared one by one, since both show the same place with the
/// same noise. Consecutive frames are similar, so this estimate is rather too small than too large;
/// - from counting: n wrong pixels have a standard error of √n (Poisson) if pixels are wrong
/// independently of each other. This matters if few pixels are wrong. If value and limit do not
/// really differ, a row fails about once in 700 times. A worst frame has only the second estimate,
/// a calibration error only the first, since wrong wraps occur as whole surfaces: the share of
/// right wraps differs between frames by much more than if pixels were wrong independently.
struct Check {
  /// False for mean_kept, worst_kept and surest_kept in ambient light, and without any errors.
  bool applies = false;
  double value = 0;
  double limit = 0;
  double allowance = 0;

  bool holds() const { return !applies || value <= limit + allowance; }

  /// The value minus the limit and the allowance; 0 or less if the condition holds.
  double excess() const { return applies ? value - limit - allowance : 0; }
};

using Checks = std::array<Check, condition_count>;  ///< in the order of Condition

/// Checks all conditions for one row.
Checks check_row(const Grid& grid, const GridRow& row);

}  // namespace tofmap::accuracy
