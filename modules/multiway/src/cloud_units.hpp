// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tofmap {

/// A unit of length that one cloud may be in while the others are in another.
struct LengthUnit {
  double length = 1;  ///< in units of the other clouds
  std::string name;   ///< for example "millimetres"
};

/// Which clouds have a common size, judged by their point spacings, each in the unit of its cloud:
/// the largest group whose spacings differ from that of one of its members by less than a factor of
/// eight. Of equally large groups, the one whose spacing is closest to that of a room in metres.
std::vector<bool> of_common_size(std::span<const double> spacings);

/// Units that would make a cloud about as large as the others, best first. Empty if its spacing
/// already differs by less than a factor of two.
std::vector<LengthUnit> likely_units(double spacing, double spacing_of_others);

}  // namespace tofmap
