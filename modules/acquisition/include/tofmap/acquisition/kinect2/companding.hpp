// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tofmap::kinect2 {

/// Number of codes. A code has 11 bits.
inline constexpr int code_count = 2048;

/// The code of a saturated pixel. It takes the place of minus zero.
inline constexpr int saturation_code = 1024;

/// The measurement of a saturated pixel. It is larger than every other measurement.
inline constexpr std::int16_t saturated_measurement = 32767;

/// Largest magnitude of a measurement that is not saturated: the magnitude of code 1023.
inline constexpr int largest_magnitude = 16320;

/// The measurement that a code stands for.
///
/// The camera compands measurements: the larger the magnitude, the coarser the step. Codes 0 to
/// 1023 are the magnitudes 0 to 16320. With s = ⌊code / 128⌋, the magnitude is the code itself for
/// s = 0, and otherwise (128 + code mod 128) · 2^(s − 1). Codes 1025 to 2047 are the same
/// magnitudes, negative. `saturation_code` is `saturated_measurement`.
///
/// Throws UsageError unless `code` is in [0, 2048).
std::int16_t measurement_of_code(int code);

/// The code whose measurement is nearest to `measurement`. Of two equally near ones, it is the code
/// of the larger magnitude. Magnitudes from 16352 on, which would be rounded to more than
/// `largest_magnitude`, are saturated.
int nearest_code(int measurement);

}  // namespace tofmap::kinect2
