// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "upright_box.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d turn(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
}

/// Whether the projections of a triangle and of a box around the origin on an axis are apart.
bool are_apart(const std::array<Vector3d, 3>& triangle_m, const Vector3d& half_m,
               const Vector3d& axis) {
  const double radius = half_m.dot(axis.cwiseAbs());
  const auto [low, high] =
      std::minmax({axis.dot(triangle_m[0]), axis.dot(triangle_m[1]), axis.dot(triangle_m[2])});
  return low > radius || high < -radius;
}

/// Whether a vertical side plane of box `a` separates it from box `b`.
bool has_separating_side(const UprightBox& a, const UprightBox& b) {
  const Vector3d between = a.local_m(b.centre_m);
  const Eigen::Matrix3d rotation = turn(b.yaw_rad - a.yaw_rad).cwiseAbs();
  const Vector3d reach = a.half_m + rotation * b.half_m;
  return std::abs(between.x()) > reach.x() || std::abs(between.y()) > reach.y();
}

}  // namespace

Vector3d UprightBox::local_m(const Vector3d& point_m) const {
  return turn(-yaw_rad) * (point_m - centre_m);
}

Vector3d UprightBox::world_m(const Vector3d& local_m) const {
  return centre_m + turn(yaw_rad) * local_m;
}

double gap_m(const UprightBox& box, const Vector3d& point_m) {
  return (box.local_m(point_m).cwiseAbs() - box.half_m).cwiseMax(0).norm();
}

double horizontal_gap_m(const UprightBox& box, const Vector3d& point_m) {
  return (box.local_m(point_m).cwiseAbs() - box.half_m).head<2>().cwiseMax(0).norm();
}

bool intersects(const UprightBox& box, const std::array<Vector3d, 3>& triangle_m) {
  std::array<Vector3d, 3> local;
  for (std::size_t i = 0; i < 3; ++i) local[i] = box.local_m(triangle_m[i]);
  const std::array<Vector3d, 3> axes{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  const std::array<Vector3d, 3> edges{local[1] - local[0], local[2] - local[1],
                                      local[0] - local[2]};
  if (are_apart(local, box.half_m, edges[0].cross(edges[1]))) return false;
  for (const Vector3d& axis : axes) {
    if (are_apart(local, box.half_m, axis)) return false;
    for (const Vector3d& edge : edges) {
      if (are_apart(local, box.half_m, axis.cross(edge))) return false;
    }
  }
  return true;
}

bool intersects(const UprightBox& a, const UprightBox& b) {
  const double between_m = std::abs(a.centre_m.z() - b.centre_m.z());
  if (between_m > a.half_m.z() + b.half_m.z()) return false;
  return !has_separating_side(a, b) && !has_separating_side(b, a);
}

}  // namespace tofmap
