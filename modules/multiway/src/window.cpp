// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "window.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>

namespace tofmap {
namespace {

/// The limits of may_be_window(). Windows are seldom wider than 3 m without a bar, and blinds and
/// panes lie within the depth of a wall. A door, which has no frame at the floor, leaves a gap of
/// at least 45 degrees around its middle if it is as wide as half of its height.
constexpr double widest_m = 3;
constexpr double deepest_m = 0.25;
constexpr double widest_gap_rad = 40 * std::numbers::pi / 180;
constexpr double off_plane_voxels = 0.5;
constexpr double least_on_plane_share = 0.9;
constexpr double least_parallel_cos = 0.8;

/// A plane with two axes.
struct Plane {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 2, 3> axes = Eigen::Matrix<double, 2, 3>::Zero();

  double off_m(const Eigen::Vector3f& point_m) const {
    return std::abs(normal.dot(point_m.cast<double>() - middle_m));
  }
  Eigen::Vector2d along_m(const Eigen::Vector3f& point_m) const {
    return axes * (point_m.cast<double>() - middle_m);
  }
};

Plane plane_through(const OrientedCloud& cloud, std::span<const int> region) {
  Plane plane;
  for (const int i : region) plane.middle_m += cloud.points_m[i].cast<double>();
  plane.middle_m /= static_cast<double>(region.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int i : region) {
    const Eigen::Vector3d off_m = cloud.points_m[i].cast<double>() - plane.middle_m;
    spread += off_m * off_m.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  plane.normal = axes.eigenvectors().col(0);
  plane.axes = axes.eigenvectors().rightCols<2>().transpose();
  return plane;
}

/// The places of a region's points on the plane. Empty if they are not flat or too large.
std::optional<std::vector<Eigen::Vector2d>> pane(const OrientedCloud& cloud,
                                                 std::span<const int> region, const Plane& plane) {
  const double thickness_m = off_plane_voxels * cloud.voxel_m;
  const auto on_plane = std::ranges::count_if(
      region, [&](int i) { return plane.off_m(cloud.points_m[i]) <= thickness_m; });
  if (static_cast<double>(on_plane) < least_on_plane_share * static_cast<double>(region.size())) {
    return std::nullopt;
  }
  std::vector<Eigen::Vector2d> places_m;
  Eigen::AlignedBox2d box_m;
  for (const int i : region) {
    places_m.push_back(plane.along_m(cloud.points_m[i]));
    box_m.extend(places_m.back());
  }
  if (box_m.sizes().maxCoeff() > widest_m) return std::nullopt;
  return places_m;
}

/// The angles around the middle of the plane at which a frame surrounds the pane.
std::vector<double> frame_angles(const OrientedCloud& cloud, std::span<const Sight> sights,
                                 const Plane& plane, const std::vector<Eigen::Vector2d>& pane_m,
                                 double reach_m) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sights[i] != Sight::surface || plane.off_m(cloud.points_m[i]) > deepest_m) continue;
    const double parallel = std::abs(plane.normal.dot(cloud.normals[i].cast<double>()));
    if (parallel < least_parallel_cos) continue;
    const Eigen::Vector2d place_m = plane.along_m(cloud.points_m[i]);
    const bool is_beside = std::ranges::any_of(
        pane_m, [&](const auto& part_m) { return (part_m - place_m).norm() <= reach_m; });
    if (is_beside) angles.push_back(std::atan2(place_m.y(), place_m.x()));
  }
  return angles;
}

double widest_gap(std::vector<double> angles) {
  std::ranges::sort(angles);
  double widest = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) {
    widest = std::max(widest, angles[i] - angles[i - 1]);
  }
  return widest;
}

}  // namespace

bool may_be_window(const OrientedCloud& cloud, std::span<const int> region,
                   std::span<const Sight> sights, double reach_m) {
  if (region.size() < 3) return false;
  const Plane plane = plane_through(cloud, region);
  const auto pane_m = pane(cloud, region, plane);
  if (!pane_m) return false;
  const std::vector<double> angles = frame_angles(cloud, sights, plane, *pane_m, reach_m);
  return !angles.empty() && widest_gap(angles) <= widest_gap_rad;
}

}  // namespace tofmap
