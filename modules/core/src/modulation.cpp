// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/modulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap {

void validate(const Modulation& modulation) {
  const double a = modulation.frequency_a_hz;
  const double b = modulation.frequency_b_hz;
  if (!(std::isfinite(a) && std::isfinite(b) && a > 0 && b > 0)) {
    std::ostringstream message;
    message << "modulation: frequencies must be positive, got " << a << " and " << b << " Hz";
    throw InputError(message.str());
  }
  constexpr double lowest_hz = 1e4;    // λ = 15 km; a number of megahertz would be far below
  constexpr double highest_hz = 1e11;  // λ = 1.5 mm
  if (std::min(a, b) < lowest_hz || std::max(a, b) > highest_hz) {
    std::ostringstream message;
    message << "modulation: frequencies of " << a << " and " << b
            << " Hz are implausible for a time-of-flight camera; give them in hertz, e.g. 29e6";
    throw InputError(message.str());
  }
  if (std::abs(a - b) < 1e-6 * a) {
    std::ostringstream message;
    message << "modulation: frequency_a_hz and frequency_b_hz are equal (" << a
            << " Hz); wraps can only be told apart by two different frequencies";
    throw InputError(message.str());
  }
}

double combined_range_m(const Modulation& modulation, double tolerance_cycles) {
  const double longer = std::max(modulation.wavelength_a_m(), modulation.wavelength_b_m());
  const double shorter = std::min(modulation.wavelength_a_m(), modulation.wavelength_b_m());
  // During one wrap of the longer wavelength, the phase of the shorter one advances by
  // longer / shorter cycles. By Dirichlet's approximation theorem it returns to within 1 / n of a
  // whole cycle after at most n wraps.
  const int last = static_cast<int>(std::ceil(1 / std::max(tolerance_cycles, 1e-6)));
  for (int n = 1; n < last; ++n) {
    const double cycles = n * longer / shorter;
    if (std::abs(cycles - std::round(cycles)) <= tolerance_cycles) return n * longer;
  }
  return last * longer;
}

WrapLimits wrap_limits(const Modulation& modulation, double max_range_m) {
  if (!(std::isfinite(max_range_m) && max_range_m > 0)) {
    throw UsageError("max_range_m must be a positive number of metres");
  }
  const auto count = [&](double wavelength_m) {
    return static_cast<int>(std::ceil(max_range_m / wavelength_m - 1e-9));
  };
  return {count(modulation.wavelength_a_m()), count(modulation.wavelength_b_m())};
}

}  // namespace tofmap
