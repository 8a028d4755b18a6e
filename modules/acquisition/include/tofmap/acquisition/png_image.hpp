// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Reads a gray PNG of exactly 16 (8) bits. Throws InputError that names the file if it is
/// missing, truncated, no PNG, or of another depth or colour type.
ImageU16 read_png_16(const std::filesystem::path& file);
ImageU8 read_png_8(const std::filesystem::path& file);

/// Writes a gray PNG. Throws InputError that names the file if it cannot be written whole.
void write_png(const std::filesystem::path& file, const ImageU16& image);
void write_png(const std::filesystem::path& file, const ImageU8& image);

}  // namespace tofmap
