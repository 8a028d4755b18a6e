// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// The constant range errors of individual pixels, measured minus true, in metres: an image of the
/// camera's size for each frequency. They come from the different delays of the pixels' clocks and
/// readout ("fixed pattern"). A pixel whose error is unknown is NaN and is not corrected. Empty: no
/// pattern.
using FixedPattern = std::vector<ImageF>;

/// The largest error that a pixel may have. Metres. A larger number is no range error but a mistake
/// in the file, such as millimetres.
inline constexpr double largest_pattern_error_m = 0.5;

/// Reads a pattern from a .npy file with an array of type float32 and shape (frequencies, rows,
/// columns). Throws InputError, which names the file and the remedy, if the file is missing,
/// truncated, or of another type or shape, if a frequency has no number that is not NaN, or if an
/// error exceeds largest_pattern_error_m.
FixedPattern read_fixed_pattern(const std::filesystem::path& file);

/// Writes a pattern, from which read_fixed_pattern() reads the same bits. Throws UsageError if
/// there is no image or the images differ in size, and InputError if the file cannot be written
/// completely.
void write_fixed_pattern(const std::filesystem::path& file, const FixedPattern& pattern);

/// Throws InputError if there is a pattern and it is not of this number of frequencies, or its
/// images are not of the camera's size. The message does not name the file.
void check_fixed_pattern(const FixedPattern& pattern, std::size_t frequencies, int width_px,
                         int height_px);

/// Subtracts the pattern from the phases of a frame, which must have passed check_fixed_pattern().
/// The phases stay in [0, 1); NaN stays NaN.
void subtract_fixed_pattern(Frame& frame, const Modulation& modulation,
                            const FixedPattern& pattern);

}  // namespace tofmap
