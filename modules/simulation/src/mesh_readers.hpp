// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

// These readers replace those of VTK, which do not withstand damaged files: the PLY reader of VTK
// 9.1 frees memory twice if a file is truncated, and accepts a last face that is incomplete.

/// Reflectance of vertices without colours.
inline constexpr double unknown_reflectance = 0.5;

/// Reads a PLY mesh. Throws InputError, which names the file, if it is damaged.
TriangleMesh read_ply_mesh(const std::filesystem::path& file);

/// Reads an OBJ mesh. Throws InputError, which names the file, if it is damaged.
TriangleMesh read_obj_mesh(const std::filesystem::path& file);

/// Throws InputError with the message "FILE: WHAT".
[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& what);

/// The bytes of a file. Throws InputError if it does not exist or cannot be opened.
std::string read_bytes(const std::filesystem::path& file);

/// Adds a convex polygon as a fan of triangles. `corners` are indices, from 0, of vertices that the
/// mesh has already. Throws InputError if there is no such vertex.
void add_polygon(TriangleMesh& mesh, std::span<const long> corners,
                 const std::filesystem::path& file);

}  // namespace tofmap
