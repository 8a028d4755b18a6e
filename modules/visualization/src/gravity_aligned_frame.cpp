// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/map_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <tuple>
#include <vector>

namespace tofmap {
namespace {

/// The mean upward direction of the cameras. −y of the map if the trajectory is empty or the
/// directions cancel.
Eigen::Vector3d upward_of_cameras(const Trajectory& trajectory) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory) sum -= pose.world_from_camera.linear().col(1);
  return sum.norm() > 1e-3 ? sum.normalized() : Eigen::Vector3d(0, -1, 0);
}

/// About `count` normals of the map, evenly spread over its points.
std::vector<Eigen::Vector3d> some_normals(const MapCloud& map, std::size_t count) {
  std::vector<Eigen::Vector3d> normals;
  const std::size_t step = std::max<std::size_t>(1, map.size() / count);
  for (std::size_t i = 0; i < map.size(); i += step) {
    const Eigen::Vector3d normal = map[i].getNormalVector3fMap().cast<double>();
    if (normal.allFinite()) normals.push_back(normal);
  }
  return normals;
}

constexpr double same_direction_rad = 8 * std::numbers::pi / 180;

/// The number of normals that are those of floors (parallel to `up`) or walls (perpendicular to
/// it), within 8°.
int count_explained(const std::vector<Eigen::Vector3d>& normals, const Eigen::Vector3d& up) {
  const double floor_cosine = std::cos(same_direction_rad);
  const double wall_cosine = std::sin(same_direction_rad);
  return static_cast<int>(std::ranges::count_if(normals, [&](const Eigen::Vector3d& normal) {
    const double cosine = normal.dot(up);
    return cosine > floor_cosine || std::abs(cosine) < wall_cosine;
  }));
}

/// The vertical direction of a room: of the normals within 50° of `guess`, the one that explains
/// most normals, averaged over the normals close to it. `guess` if there are none.
Eigen::Vector3d upward_of_room(const MapCloud& map, const Eigen::Vector3d& guess) {
  constexpr double farthest_rad = 50 * std::numbers::pi / 180;
  const std::vector<Eigen::Vector3d> normals = some_normals(map, 4000);
  Eigen::Vector3d best = guess;
  int most = 0;
  for (const Eigen::Vector3d& candidate : some_normals(map, 600)) {
    if (candidate.dot(guess) < std::cos(farthest_rad)) continue;
    const int explained = count_explained(normals, candidate);
    if (explained <= most) continue;
    most = explained;
    best = candidate;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& normal : normals) {
    if (normal.dot(best) > std::cos(same_direction_rad)) sum += normal;
  }
  return sum.norm() > 0 ? sum.normalized() : best;
}

/// The angle of the walls about z, modulo 90°: a quarter of the phase of the mean of exp(4 i α),
/// where α is the angle of the normal of a wall.
double wall_angle_rad(const MapCloud& map, const Eigen::Matrix3d& aligned_from_map) {
  std::complex<double> sum = 0;
  for (const MapPoint& point : map) {
    const Eigen::Vector3d normal = aligned_from_map * point.getNormalVector3fMap().cast<double>();
    if (!(std::abs(normal.z()) < 0.3)) continue;
    sum += std::polar(1.0, 4 * std::atan2(normal.y(), normal.x()));
  }
  return std::arg(sum) / 4;
}

/// The smallest and the largest value without outliers: 0.5 % of the values at either end. `values`
/// must not be empty.
std::pair<double, double> limits(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t strays = values.size() / 200;
  return {values[strays], values[values.size() - 1 - strays]};
}

/// A frame rotated by 90° about z: the new x is the old −y, and the new y is the old x.
GravityAlignedFrame turned_by_a_quarter(const GravityAlignedFrame& frame) {
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Vector3d low = frame.box_m.min();
  const Eigen::Vector3d high = frame.box_m.max();
  return {turn * frame.aligned_from_map,
          Eigen::AlignedBox3d(Eigen::Vector3d(-high.y(), low.x(), low.z()),
                              Eigen::Vector3d(-low.y(), high.x(), high.z()))};
}

}  // namespace

Eigen::AlignedBox3d gravity_aligned_box(const MapCloud& map,
                                        const Eigen::Matrix3d& aligned_from_map) {
  if (map.empty()) return {};
  std::array<std::vector<double>, 3> coordinates;
  for (const MapPoint& point : map) {
    const Eigen::Vector3d p = aligned_from_map * point.getVector3fMap().cast<double>();
    for (int axis = 0; axis < 3; ++axis) {
      coordinates[static_cast<std::size_t>(axis)].push_back(p[axis]);
    }
  }
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (int axis = 0; axis < 3; ++axis) {
    std::tie(low[axis], high[axis]) =
        limits(std::move(coordinates[static_cast<std::size_t>(axis)]));
  }
  return {low, high};
}

GravityAlignedFrame gravity_aligned_frame(const MapCloud& map, const Trajectory& trajectory) {
  GravityAlignedFrame frame;
  if (map.empty()) return frame;
  const Eigen::Vector3d up = upward_of_room(map, upward_of_cameras(trajectory));
  frame.aligned_from_map =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  frame.aligned_from_map =
      Eigen::AngleAxisd(-wall_angle_rad(map, frame.aligned_from_map), Eigen::Vector3d::UnitZ()) *
      frame.aligned_from_map;
  frame.box_m = gravity_aligned_box(map, frame.aligned_from_map);
  return frame.box_m.sizes().y() > frame.box_m.sizes().x() ? turned_by_a_quarter(frame) : frame;
}

}  // namespace tofmap
