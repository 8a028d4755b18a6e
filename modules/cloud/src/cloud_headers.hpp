// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

namespace tofmap {

// PCL's readers crash on files whose header contradicts itself. These functions read headers only.
// They throw InputError, which does not name the file.

/// Throws unless a file has the header of a PCD file: FIELDS, SIZE, TYPE and COUNT have as many
/// values, in their ranges, and an uncompressed binary file is as large as its points.
void check_pcd_header(const std::filesystem::path& file);

/// Throws unless a file has the header of a PLY file whose points have no lists, and, if it is
/// binary, is as large as its points.
void check_ply_header(const std::filesystem::path& file);

/// Throws since a file ends before the last of its `points`.
[[noreturn]] void fail_as_cut_off(std::size_t points);

}  // namespace tofmap
