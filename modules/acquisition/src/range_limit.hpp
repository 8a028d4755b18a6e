// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/core/modulation.hpp>
#include <tofmap/core/number_text.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// What is wrong with the longest range of a recording: it needs more wrap counts than 8-bit images
/// hold. Empty if nothing is.
inline std::string range_limit_fault(double max_range_m, const Modulation& modulation) {
  const double most_m = invalid_wrap_count * modulation.wavelength_m(0);
  if (max_range_m <= most_m) return "";
  return "must be at most " + std::to_string(invalid_wrap_count) +
         " wavelengths of the first frequency, " + shortest(most_m) +
         " m; give metres, not millimetres";
}

}  // namespace tofmap
