// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// A triangle mesh with shared vertices, in the world frame. The vertices of a triangle are in
/// counter-clockwise order when seen from the side that the normals point to.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> points_m;                ///< vertices
  std::vector<Eigen::Vector3f> normals;                 ///< of each vertex, unit length
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
};

/// Writes a binary PLY file with vertices (x y z nx ny nz) and faces. Throws InputError, which
/// names the file, if it cannot be written completely.
void write_mesh(const std::filesystem::path& file, const SurfaceMesh& mesh);

}  // namespace tofmap
