// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap::test {

constexpr double wall_voxel_m = 0.1;

/// A rectangle of points at a distance x, about a middle in y and z.
inline std::vector<Eigen::Vector3d> wall(double x_m, double half_y_m, double half_z_m,
                                         const Eigen::Vector2d& middle_m = {0, 0}) {
  std::vector<Eigen::Vector3d> points;
  const int across = static_cast<int>(std::lround(half_y_m / wall_voxel_m));
  const int up = static_cast<int>(std::lround(half_z_m / wall_voxel_m));
  for (int i = -across; i <= across; ++i) {
    for (int k = -up; k <= up; ++k) {
      points.emplace_back(x_m, middle_m.x() + i * wall_voxel_m, middle_m.y() + k * wall_voxel_m);
    }
  }
  return points;
}

inline OrientedCloud oriented(const std::vector<Eigen::Vector3d>& points) {
  return *orient(points, wall_voxel_m, Eigen::Vector3d::Zero());
}

}  // namespace tofmap::test
