// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <random>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap::test {

/// What a scanner of 110 by 80 degrees with a noise of 5 mm sees of a scene, in its own frame.
inline PointSet scan(const RayScene& scene, const Pose& world_from_sensor, unsigned seed = 1) {
  constexpr int cols = 160;
  constexpr int rows = 110;
  CameraModel scanner;
  scanner.width_px = cols;
  scanner.height_px = rows;
  scanner.fx_px = scanner.fy_px = 56;
  scanner.cx_px = 0.5 * (cols - 1);
  scanner.cy_px = 0.5 * (rows - 1);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_m(0, 0.005);
  PointSet points;
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const Eigen::Vector3d ray = pixel_ray(scanner, u, v);
      const auto hit =
          scene.cast(world_from_sensor.translation(), world_from_sensor.linear() * ray, 100);
      if (hit) points.points.emplace_back((hit->range_m + noise_m(random)) * ray);
    }
  }
  return points;
}

inline PointSet scaled(PointSet points, double factor) {
  for (Eigen::Vector3d& point : points.points) point *= factor;
  return points;
}

}  // namespace tofmap::test
