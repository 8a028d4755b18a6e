// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/frequency_residual.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// The difference from the nearest whole number, −1/2 … 1/2.
double wrapped(double cycles) { return cycles - std::round(cycles); }

}  // namespace

double frequency_residual_m(double wavelength_a_m, double wavelength_b_m, double cycles_a,
                            double phase_b) {
  return wrapped(cycles_a * wavelength_a_m / wavelength_b_m - phase_b) * wavelength_b_m;
}

double residual_shift_cycles(double wavelength_ratio, int wraps) {
  return wrapped(wraps * wavelength_ratio);
}

double residual_step_m(double wavelength_a_m, double wavelength_b_m, int counts) {
  const double ratio = wavelength_a_m / wavelength_b_m;
  double least_cycles = 1;
  for (int wraps = 1; wraps < counts; ++wraps) {
    const double cycles = std::abs(residual_shift_cycles(ratio, wraps));
    if (cycles > indistinguishable_cycles) least_cycles = std::min(least_cycles, cycles);
  }
  return least_cycles * wavelength_b_m;
}

}  // namespace tofmap
