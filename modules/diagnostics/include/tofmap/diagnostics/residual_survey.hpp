// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

/// How well the first frequency of a recording, A, and another one, B, agree. Each pixel is
/// considered by itself, with the wrap counts that make its two ranges agree best.
struct ResidualSurvey {
  std::size_t frequency = 1;  ///< that of B, counted from 0
  /// Median difference of A's range minus B's range. If several offsets fit equally well, the one
  /// nearest to zero.
  double offset_m = 0;
  /// The other offsets that fit equally well, nearest to zero first. They correspond to other wrap
  /// counts of both frequencies.
  std::vector<double> other_offsets_m;
  double spread_m = 0;          ///< robust standard deviation of single pixels about `offset_m`
  double swapped_spread_m = 0;  ///< `spread_m` if the frequencies of A and B are swapped
  /// Another frequency, counted from 0, with which B seems to be exchanged: with the wavelengths of
  /// each other, the two agree much better with A. 0: none.
  std::size_t exchanged_with = 0;
  /// By how much A's range minus B's range changes with one more wrap of both: |λ_A − λ_B|.
  double ambiguity_m = 0;
};

/// Compares the first frequency with each other one, in some frames of a recording. A frequency is
/// left out if fewer than 300 of the pixels looked at, which are every third, have returns at both.
std::vector<ResidualSurvey> survey_residuals(const std::vector<Frame>& frames,
                                             const SensorModel& sensor);

/// A warning, with the remedy, if the images of A and B seem not to belong together. Otherwise
/// empty. Much noise looks the same, unless the frames agree on a map (`map_agrees`).
std::optional<std::string> pairing_warning(const ResidualSurvey& residual, bool map_agrees = false);

/// A warning, with the remedy, if the offset between the frequencies is uncertain. It is uncertain
/// if unwrapping estimated another offset (`camera`; null if unknown), or if it is so large that
/// other offsets that fit the phases are nearly as likely. Empty if the offset is below 2 cm, or if
/// both estimates agree on a small offset, which unwrapping compensates for. They may also agree on
/// a large one, or differ as noise makes them, if the frames agree on a map (`map_agrees`): another
/// offset means other wrap counts, with which frames contradict each other.
std::optional<std::string> offset_warning(const ResidualSurvey& residual,
                                          const CameraErrors* camera, bool map_agrees = false);

/// A warning if the frequencies cannot tell wrap counts apart. Otherwise empty, as for a single
/// frequency if no range exceeds its wavelength: `max_range_m`, or, if it is 0, what the sensor
/// says. Throws UsageError as unwrap_limits() does.
std::optional<std::string> frequency_warning(const SensorModel& sensor, double max_range_m = 0);

/// A warning if the first frequency, relative to which errors are estimated, has a wavelength more
/// than twice the shortest. Otherwise empty.
std::optional<std::string> order_warning(const Modulation& modulation);

}  // namespace tofmap
