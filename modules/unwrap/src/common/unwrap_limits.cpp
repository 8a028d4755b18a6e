// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/unwrap_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

PairLimits UnwrapLimits::pair(std::size_t a, std::size_t b) const {
  PairLimits pair;
  pair.wavelength_a_m = wavelengths_m[a];
  pair.wavelength_b_m = b < wavelengths_m.size() ? wavelengths_m[b] : 0;
  pair.max_range_m = max_range_m;
  pair.count_a = a == 0 ? count : wrap_limit(wavelengths_m[a], max_range_m);
  return pair;
}

UnwrapLimits unwrap_limits(const SensorModel& sensor, double max_range_m) {
  UnwrapLimits limits;
  limits.wavelengths_m = wavelengths_m(sensor.modulation);
  const double most_m = invalid_wrap_count * limits.wavelength_m();  // 255 wrap counts fit 8 bits
  const double combined_m = sensor.modulation.count() == 1
                                ? most_m
                                : combined_range_m(sensor.modulation, noise_tolerance_cycles);
  limits.max_range_m = max_range_m > 0          ? max_range_m
                       : sensor.max_range_m > 0 ? sensor.max_range_m
                                                : std::min(most_m, combined_m);
  limits.count = wrap_limit(limits.wavelength_m(), limits.max_range_m);
  if (limits.count > invalid_wrap_count) {
    throw UsageError("max_range_m: " + std::to_string(limits.max_range_m) + " m needs " +
                     std::to_string(limits.count) + " wrap counts; allowed: at most 255, that is " +
                     std::to_string(most_m) + " m");
  }
  return limits;
}

bool can_tell_apart(const UnwrapLimits& limits, int wrap_count, int other_wrap_count) {
  const auto tells = [&](double wavelength_m) {
    const double ratio = limits.wavelength_m() / wavelength_m;
    return std::abs(residual_shift_cycles(ratio, wrap_count - other_wrap_count)) >
           noise_tolerance_cycles;
  };
  return std::any_of(limits.wavelengths_m.begin() + 1, limits.wavelengths_m.end(), tells);
}

double residual_noise_steps(const UnwrapLimits& limits) {
  double least_squared = std::numeric_limits<double>::infinity();
  for (int wraps = 1; wraps < limits.count; ++wraps) {
    double squared = 0;  // of the change of all residuals, in standard deviations
    for (std::size_t f = 1; f < limits.frequencies(); ++f) {
      const double wavelength_m = limits.wavelengths_m[f];
      const double shift = residual_shift_cycles(limits.wavelength_m() / wavelength_m, wraps);
      if (std::abs(shift) <= indistinguishable_cycles) continue;
      const double sigma_m = std::numbers::sqrt2 * std::max(limits.wavelength_m(), wavelength_m);
      squared += std::pow(shift * wavelength_m / sigma_m, 2);
    }
    if (squared > 0) least_squared = std::min(least_squared, squared);
  }
  return 1 / std::sqrt(least_squared);
}

}  // namespace tofmap
