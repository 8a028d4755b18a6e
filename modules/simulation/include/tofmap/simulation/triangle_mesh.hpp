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

/// A surface that the simulated camera looks at: world frame, z up, metres. Both sides of a
/// triangle reflect. Reflectance is given per vertex, 0 … 1, and is interpolated.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<float> reflectance;  ///< one per vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh);

/// A rectangle or parallelogram with the corners c, c + a, c + a + b, c + b.
void add_quad(TriangleMesh& mesh, const Eigen::Vector3d& c, const Eigen::Vector3d& a,
              const Eigen::Vector3d& b, double reflectance);

/// An axis-parallel box between two opposite corners.
void add_box(TriangleMesh& mesh, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
             double reflectance);

/// The same, turned by `yaw_rad` about the vertical through its middle.
void add_turned_box(TriangleMesh& mesh, const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                    double yaw_rad, double reflectance);

/// An upright cylinder with closed ends.
void add_cylinder(TriangleMesh& mesh, const Eigen::Vector3d& base, double radius_m, double height_m,
                  double reflectance);

/// A hole in a wall: `from_m` … `to_m` along it, `bottom_m` … `top_m` above its foot.
struct WallOpening {
  double from_m = 0;
  double to_m = 0;
  double bottom_m = 0;
  double top_m = 0;
};

/// An upright wall from the foot points `from` to `to`, `thickness_m` thick to the left of that
/// direction. Openings are given in their order along the wall and do not overlap.
void add_wall(TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              double height_m, double thickness_m, const std::vector<WallOpening>& openings,
              double reflectance);

/// Reads a PLY or OBJ mesh (by the file's ending; PLY with vertex colours: their mean is
/// the reflectance times 255; without colours the reflectance is 0.5). Polygons (convex) are cut
/// into triangles. Throws InputError that names the file if it is missing or damaged, of another
/// kind, holds no triangle, or spans over a kilometre (then it is hardly in metres).
TriangleMesh read_mesh(const std::filesystem::path& file);

/// Writes binary PLY with the reflectance as gray vertex colours. Throws InputError that names the
/// file if it cannot be written whole.
void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace tofmap
