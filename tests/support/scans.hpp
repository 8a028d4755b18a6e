// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <cmath>
#include <numbers>
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

/// Adds points at a limit of range in the upper half of all directions from the origin, as a sensor
/// writes them for rays without a return.
inline PointSet with_limit(PointSet cloud, double limit_m, int count) {
  for (int i = 0; i < count; ++i) {
    const double up = (i + 0.5) / count;
    const double azimuth = 2 * std::numbers::pi * std::numbers::phi * i;
    const double across = std::sqrt(1 - up * up);
    cloud.points.emplace_back(
        limit_m * Eigen::Vector3d(across * std::cos(azimuth), across * std::sin(azimuth), up));
  }
  return cloud;
}

inline PointSet moved(PointSet cloud, const Pose& motion) {
  for (Eigen::Vector3d& point : cloud.points) point = motion * point;
  return cloud;
}

inline PointSet scaled(PointSet points, double factor) {
  for (Eigen::Vector3d& point : points.points) point *= factor;
  return points;
}

}  // namespace tofmap::test
