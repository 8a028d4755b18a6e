// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace tofmap::kinect2 {

/// All bytes of a file. Of a file of more than `most` bytes, only the first `most` + 1 are read, so
/// that the caller can refuse it. Throws InputError, which names the file, if it cannot be read.
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file, std::size_t most);

/// Writes a file under another name beside it and then moves it into place, so that the file is
/// whole or absent after an interruption. Throws InputError, which names the file, if it cannot be
/// written.
void write_whole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace tofmap::kinect2
