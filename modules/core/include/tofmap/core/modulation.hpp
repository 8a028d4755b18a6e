// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

inline constexpr double speed_of_light_m_per_s = 299792458.0;

/// The two modulation frequencies of a dual-frequency camera. Range images of one
/// frequency repeat after its wavelength (non-ambiguity range) λ = c / 2f.
/// Either of the two may be the longer.
struct Modulation {
  double frequency_a_hz = 0;
  double frequency_b_hz = 0;

  double wavelength_a_m() const { return speed_of_light_m_per_s / (2 * frequency_a_hz); }
  double wavelength_b_m() const { return speed_of_light_m_per_s / (2 * frequency_b_hz); }
};

/// Throws InputError if a frequency is not a positive number or none of a camera's (below 10 kHz,
/// above 100 GHz: wrong units), or both are equal (then the
/// second image says nothing about wraps).
void validate(const Modulation& modulation);

/// The combined unambiguous range: the smallest positive range at which both phases return
/// to zero within `tolerance_cycles`, metres. With a tolerance near zero it is c / 2 gcd(f_A,
/// f_B) (29 and 31 MHz: 149.9 m; 80 and 100 MHz: 7.5 m). A tolerance of the size of the
/// phase noise gives the range within which the pair can be told apart in practice (29 and
/// 31 MHz at 0.05 cycles: 72.4 m). Pairs without a common divisor end at the tolerance.
double combined_range_m(const Modulation& modulation, double tolerance_cycles = 1e-3);

/// How many wrap counts 0 … count − 1 the ranges below `max_range_m` can have.
struct WrapLimits {
  int count_a = 0;
  int count_b = 0;
};

/// Limits for ranges in [0, max_range_m). Throws UsageError unless max_range_m > 0.
WrapLimits wrap_limits(const Modulation& modulation, double max_range_m);

}  // namespace tofmap
