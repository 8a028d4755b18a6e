// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tofmap {

/// A surface that the simulated camera looks at. World frame, z up, metres. Both sides of a
/// triangle reflect.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<float> reflectance;  ///< of each vertex, 0 … 1; interpolated over triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
};

/// The axis-aligned bounding box of all vertices. Empty if there are none.
Eigen::AlignedBox3d bounds(const TriangleMesh& mesh);

/// Adds all vertices and triangles of another mesh.
void add_mesh(TriangleMesh& mesh, const TriangleMesh& other);

/// Adds a parallelogram with the corners c, c + a, c + a + b, c + b, metres.
void add_quad(TriangleMesh& mesh, const Eigen::Vector3d& c, const Eigen::Vector3d& a,
              const Eigen::Vector3d& b, double reflectance);

/// Adds an axis-aligned box between two opposite corners, metres.
void add_box(TriangleMesh& mesh, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
             double reflectance);

/// Adds the box of add_box(), rotated by `yaw_rad` about the vertical axis through its centre.
void add_rotated_box(TriangleMesh& mesh, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                     double yaw_rad, double reflectance);

/// Adds an upright cylinder (a prism of 24 sides) with closed ends. `base` is the centre of its
/// lower end, metres.
void add_cylinder(TriangleMesh& mesh, const Eigen::Vector3d& base, double radius_m, double height_m,
                  double reflectance);

/// A rectangular hole in a wall.
struct WallOpening {
  double from_m = 0;    ///< along the wall, from its first foot point
  double to_m = 0;      ///< along the wall, from its first foot point
  double bottom_m = 0;  ///< above the foot of the wall
  double top_m = 0;     ///< above the foot of the wall
};

/// Adds an upright wall between the foot points `from` and `to`, metres. The wall extends
/// `thickness_m` to the left of that direction. Openings must be sorted along the wall and must not
/// overlap.
void add_wall(TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              double height_m, double thickness_m, const std::vector<WallOpening>& openings,
              double reflectance);

/// Reads a mesh in metres, z up, from a file whose name ends in .ply or .obj. The reflectance is
/// the mean of the vertex colours of a PLY file over 255, or 0.5 if there are none. Polygons must
/// be convex; they are split into triangles. Throws InputError, which names the file, if the file
/// is missing, damaged or of another kind, has no triangle, or extends over more than a kilometre
/// (its unit is hardly the metre).
TriangleMesh read_mesh(const std::filesystem::path& file);

/// Writes a binary PLY file with the reflectance times 255 as gray vertex colours. Throws
/// InputError, which names the file, if it cannot be written completely.
void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace tofmap
