// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Largest width or height of an image. Limits the memory that a damaged header can ask for.
inline constexpr int max_image_side_px = 16384;

/// Reads a gray PNG of 16 bits. Throws InputError, which names the file, if the file is missing,
/// truncated, not a PNG, or of another bit depth or colour type.
ImageU16 read_png_16(const std::filesystem::path& file);

/// Reads a gray PNG of 8 bits. Throws InputError as read_png_16() does.
ImageU8 read_png_8(const std::filesystem::path& file);

/// Writes a gray PNG of 16 bits. Throws InputError, which names the file, if it cannot be written
/// completely, and UsageError if the image is empty or a side exceeds max_image_side_px.
void write_png(const std::filesystem::path& file, const ImageU16& image);

/// Writes a gray PNG of 8 bits. Throws as for 16 bits.
void write_png(const std::filesystem::path& file, const ImageU8& image);

}  // namespace tofmap
