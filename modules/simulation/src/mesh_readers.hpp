// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

// The readers are our own because the field's are no match for damaged files: VTK 9.1's PLY
// reader frees memory twice on a truncated one, and takes a short last face as whole.

inline constexpr double unknown_reflectance = 0.5;

TriangleMesh read_ply_mesh(const std::filesystem::path& file);
TriangleMesh read_obj_mesh(const std::filesystem::path& file);

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& what);

/// The whole file as bytes.
std::string read_bytes(const std::filesystem::path& file);

/// Adds a convex polygon as a fan of triangles. `corners` count from 0; one that is no vertex of
/// the mesh is an InputError, so add the vertices first.
void add_polygon(TriangleMesh& mesh, std::span<const long> corners,
                 const std::filesystem::path& file);

}  // namespace tofmap
