// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap::test {

inline CameraModel small_camera() {
  CameraModel camera;
  camera.width_px = 88;
  camera.height_px = 72;
  camera.fx_px = camera.fy_px = 64;
  camera.cx_px = 43.5;
  camera.cy_px = 35.5;
  return camera;
}

/// Exact ranges inside an axis-parallel box (world frame), from a camera inside it.
inline RangeImage box_ranges(const CameraModel& camera, const Eigen::Vector3d& min,
                             const Eigen::Vector3d& max, const Pose& world_from_camera,
                             float sigma_m = 0.01F) {
  RangeImage image(camera.height_px, camera.width_px);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3d ray = world_from_camera.linear() * pixel_ray(camera, u, v);
      double range = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = ray[axis] > 0 ? max[axis] : min[axis];
        if (ray[axis] == 0) continue;
        range = std::min(range, (wall - world_from_camera.translation()[axis]) / ray[axis]);
      }
      image.range_m(v, u) = static_cast<float>(range);
      image.sigma_m(v, u) = sigma_m;
      image.wrap_count(v, u) = 0;
      image.confidence(v, u) = 1;
      image.reason(v, u) = 0;
    }
  }
  return image;
}

/// Range at which a ray meets an axis-parallel box from outside. Empty if it passes by.
inline std::optional<double> range_to(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& ray) {
  double nearest = 0;
  double farthest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double one = (box.min()[axis] - origin[axis]) / ray[axis];
    const double other = (box.max()[axis] - origin[axis]) / ray[axis];
    nearest = std::max(nearest, std::min(one, other));
    farthest = std::min(farthest, std::max(one, other));
  }
  return nearest < farthest ? std::optional(nearest) : std::nullopt;
}

inline Pose moved_by(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << rotation, translation;
  return pose_from_twist(twist);
}

}  // namespace tofmap::test
