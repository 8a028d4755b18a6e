// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tofmap {

/// A unit of length that a file may be in while others are not.
struct LengthUnit {
  double length = 1;  ///< in units of the others
  std::string name;   ///< "millimetres"
};

/// Which clouds are of a size, by their spacings in their own units: the largest group within a
/// factor of eight, of equal ones that whose spacing is nearest to a room's.
std::vector<bool> of_common_size(std::span<const double> spacings);

/// Units that would make a cloud about as large as the others, the most fitting first; not the
/// others' own. None if the cloud is about as large already.
std::vector<LengthUnit> likely_units(double spacing, double spacing_of_others);

}  // namespace tofmap
