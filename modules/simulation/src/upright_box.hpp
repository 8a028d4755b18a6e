// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tofmap {

/// A box that is rotated about the vertical axis through its centre. World frame, metres.
struct UprightBox {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  ///< half of its sizes along its own axes
  double yaw_rad = 0;

  /// A point of the world relative to the centre, along the axes of the box.
  Eigen::Vector3d local_m(const Eigen::Vector3d& point_m) const;

  /// The point with these coordinates along the axes of the box, relative to the centre.
  Eigen::Vector3d world_m(const Eigen::Vector3d& local_m) const;
};

/// The distance of a point from the box; 0 inside.
double gap_m(const UprightBox& box, const Eigen::Vector3d& point_m);

/// The same, seen from above.
double horizontal_gap_m(const UprightBox& box, const Eigen::Vector3d& point_m);

/// Whether a triangle and a box have a point in common (Akenine-Möller, 'Fast 3D triangle-box
/// overlap testing', 2001).
bool intersects(const UprightBox& box, const std::array<Eigen::Vector3d, 3>& triangle_m);

/// Whether two boxes have a point in common.
bool intersects(const UprightBox& a, const UprightBox& b);

}  // namespace tofmap
