// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

namespace tofmap {

inline constexpr double speed_of_light_m_per_s = 299792458.0;

/// The largest number of modulation frequencies of a camera.
inline constexpr std::size_t most_frequencies = 8;

/// The modulation frequencies of a time-of-flight camera, one to eight, in any order. The phase of
/// each frequency repeats after its wavelength, the non-ambiguity range λ = c / 2f. Wrap counts are
/// those of the first frequency.
struct Modulation {
  std::vector<double> frequencies_hz;
  /// When the image of each frequency was exposed, seconds after the timestamp of the frame. Empty
  /// if it is unknown.
  std::vector<double> exposure_offsets_s;

  Modulation() = default;
  Modulation(std::initializer_list<double> hz) : frequencies_hz(hz) {}

  /// The number of frequencies.
  std::size_t count() const { return frequencies_hz.size(); }

  /// The wavelength of a frequency, which is counted from 0.
  double wavelength_m(std::size_t frequency) const {
    return speed_of_light_m_per_s / (2 * frequencies_hz[frequency]);
  }

  bool operator==(const Modulation&) const = default;
};

/// The letter by which messages and file names call a frequency: 'a' for the first one.
constexpr char frequency_letter(std::size_t frequency) {
  return static_cast<char>('a' + frequency);
}

/// The same letter as a capital, as texts name images: "A" for the first one.
inline std::string frequency_name(std::size_t frequency) {
  return std::string(1, static_cast<char>('A' + frequency));
}

/// All wavelengths, in the order of the frequencies.
std::vector<double> wavelengths_m(const Modulation& modulation);

/// The frequencies but the first, counted from 0, in descending order of their wavelengths, given
/// the wavelengths of all. A long wavelength tells which wrap of a shorter one is near.
std::vector<std::size_t> others_by_wavelength(const std::vector<double>& wavelengths_m);

/// Largest ratio of two wavelengths at which the phase of the longer one tells the wraps of the
/// shorter one: noise of 0.08 cycles, at which a phase is hardly of use, is then a sixth of the
/// shorter wavelength.
inline constexpr double telling_wavelength_ratio = 2;

/// The frequency, counted from 0, whose wrap counts are found first; those of the others follow
/// from the ranges. Of two frequencies it is the first one, unless its wavelength exceeds the
/// other's by more than telling_wavelength_ratio. Of more, in any order, it is the one with the
/// longest wavelength that does not exceed the shortest by more, since longer ones need fewer wrap
/// counts.
std::size_t counted_frequency(const std::vector<double>& wavelengths_m);

/// The shortest and the longest wavelength.
double shortest_wavelength_m(const Modulation& modulation);
double longest_wavelength_m(const Modulation& modulation);

/// The wavelength that relates noise of the weighted mean of all ranges to phase noise, if all
/// phases have the same noise s in cycles: the mean has a standard deviation of s times this
/// wavelength, (Σ 1 / λ²)^−½.
double mean_wavelength_m(const Modulation& modulation);

/// Throws InputError if there is no frequency or more than most_frequencies, if a frequency is not
/// a positive number, if it is implausible (below 10 kHz or above 100 GHz, which suggests a wrong
/// unit), if two frequencies are equal, so that they cannot tell wrap counts apart, or if
/// exposure_offsets_s is neither empty nor has one finite number for each frequency.
void validate(const Modulation& modulation);

/// The combined range in metres: the smallest positive range at which the phases of all frequencies
/// are zero again, within `tolerance_cycles`. Ranges below it are unambiguous. With one frequency,
/// it is the wavelength.
///
/// With a tolerance near zero the combined range is c / 2 gcd(f_1, f_2, …): 149.9 m for 29 and
/// 31 MHz, 7.5 m for 80 and 100 MHz, 18.7 m for 80, 16 and 120 MHz. A tolerance as large as the
/// phase noise gives the range that is unambiguous in practice: 72.4 m for 29 and 31 MHz at 0.05
/// cycles. If the frequencies have no common divisor, the tolerance alone determines the result.
double combined_range_m(const Modulation& modulation, double tolerance_cycles = 1e-3);

/// The number of possible wrap counts, 0 … count − 1, of a frequency with this wavelength for
/// ranges in [0, max_range_m). Throws UsageError unless `max_range_m` is a finite number above 0.
int wrap_limit(double wavelength_m, double max_range_m);

}  // namespace tofmap
