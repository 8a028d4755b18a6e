// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Triangles over shared vertices, in the world frame, metres. Seen from the side that the normals
/// point to, vertices go round counter-clockwise.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;  ///< of each vertex, unit length
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Writes a binary PLY with vertices (x y z nx ny nz) and faces. Throws InputError that names the
/// file if it cannot be written whole.
void write_mesh(const std::filesystem::path& file, const SurfaceMesh& mesh);

}  // namespace tofmap
