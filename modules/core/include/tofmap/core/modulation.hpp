// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

inline constexpr double speed_of_light_m_per_s = 299792458.0;

/// The two modulation frequencies of a dual-frequency camera. The phase of each frequency repeats
/// after its wavelength, the non-ambiguity range λ = c / 2f. Either frequency may be the higher
/// one.
struct Modulation {
  double frequency_a_hz = 0;  ///< of the image that is exposed first
  double frequency_b_hz = 0;  ///< of the image that is exposed second

  double wavelength_a_m() const { return speed_of_light_m_per_s / (2 * frequency_a_hz); }
  double wavelength_b_m() const { return speed_of_light_m_per_s / (2 * frequency_b_hz); }
};

/// Throws InputError if a frequency is not a positive number, if it is implausible (below 10 kHz or
/// above 100 GHz, which suggests a wrong unit), or if both frequencies are equal, so that they
/// cannot tell wrap counts apart.
void validate(const Modulation& modulation);

/// The combined range in metres: the smallest positive range at which both phases are zero again,
/// within `tolerance_cycles`. Ranges below it are unambiguous.
///
/// With a tolerance near zero the combined range is c / 2 gcd(f_A, f_B): 149.9 m for 29 and 31 MHz,
/// 7.5 m for 80 and 100 MHz. A tolerance as large as the phase noise gives the range that is
/// unambiguous in practice: 72.4 m for 29 and 31 MHz at 0.05 cycles. If the frequencies have no
/// common divisor, the tolerance alone determines the result.
double combined_range_m(const Modulation& modulation, double tolerance_cycles = 1e-3);

/// The number of possible wrap counts of each frequency. The wrap counts are 0 … count − 1.
struct WrapLimits {
  int count_a = 0;
  int count_b = 0;
};

/// The possible wrap counts of ranges in [0, max_range_m). Throws UsageError unless `max_range_m`
/// is a finite number above 0.
WrapLimits wrap_limits(const Modulation& modulation, double max_range_m);

}  // namespace tofmap
