// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// The wrap counts that two frequencies of a frame, A and B, can have.
struct PairLimits {
  double wavelength_a_m = 0;  ///< λ_A
  double wavelength_b_m = 0;  ///< λ_B
  double max_range_m = 0;     ///< longest range in the scene
  int count_a = 0;            ///< wrap counts of A are 0 … count_a − 1

  double wavelength_ratio() const { return wavelength_a_m / wavelength_b_m; }
};

/// The wrap counts that a frame can have.
struct UnwrapLimits {
  std::vector<double> wavelengths_m;  ///< of each frequency
  double max_range_m = 0;             ///< longest range in the scene
  int count = 0;                      ///< wrap counts of the first frequency are 0 … count − 1

  std::size_t frequencies() const { return wavelengths_m.size(); }
  double wavelength_m() const { return wavelengths_m.front(); }  ///< of the first frequency

  /// The limits of the frequencies `a` and `b`, which are counted from 0. If there is no frequency
  /// `b`, its wavelength is 0.
  PairLimits pair(std::size_t a, std::size_t b) const;
};

/// Noise of a phase that the limits tolerate, in cycles.
inline constexpr double noise_tolerance_cycles = 0.05;

/// The limits for ranges up to `max_range_m`. If it is 0, the sensor's max_range_m is used; if that
/// is 0 as well, the range up to which the frequencies are unambiguous at a noise of
/// noise_tolerance_cycles (29 and 31 MHz: 72.4 m), but at most 255 wavelengths of the first
/// frequency. A single frequency, which tells wrap counts only relative to each other, has 255.
/// Throws UsageError if the ranges need more than 255 wrap counts, which 8-bit images cannot hold.
UnwrapLimits unwrap_limits(const SensorModel& sensor, double max_range_m);

/// Whether the frequencies determine absolute wrap counts. A single frequency does so only if no
/// range exceeds its wavelength.
inline bool are_absolute(const UnwrapLimits& limits) {
  return limits.frequencies() > 1 || limits.count == 1;
}

/// Whether the frequencies can tell two wrap counts of the first one apart: false if the residuals
/// of all other frequencies differ by at most noise_tolerance_cycles, because the difference of
/// their ranges is a multiple of the combined range.
bool can_tell_apart(const UnwrapLimits& limits, int wrap_count, int other_wrap_count);

/// The noise of the residuals, as a share of the smallest change of the residuals by another wrap
/// count, if all phases have a noise of one cycle (docs/unwrapping.md, 'Confidence'). 0 if there is
/// nothing to tell apart.
double residual_noise_steps(const UnwrapLimits& limits);

}  // namespace tofmap
