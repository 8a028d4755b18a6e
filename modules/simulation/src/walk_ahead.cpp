// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "walk_ahead.hpp"

#include "noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double range_swing = 0.25;   ///< largest change of the range, as a share of it
constexpr double range_pace = 0.37;    ///< changes of range for each walk to and fro
constexpr double least_share = 0.4;    ///< of the range, of places
constexpr double largest_share = 1.6;  ///< of the range, of places

/// The horizontal direction in which the camera looks. If it looks straight down, the direction of
/// the upper edge of its image.
Vector3d horizontal_view(const Pose& world_from_camera) {
  constexpr double share_of_up = 0.2;
  const Eigen::Matrix3d axes = world_from_camera.linear();
  Vector3d view = axes.col(2) - share_of_up * axes.col(1);
  view.z() = 0;
  return view.norm() > 1e-6 ? view.normalized() : Vector3d(Vector3d::UnitX());
}

/// The range of the nearest person. If the camera is far above the floor, the person is where the
/// optical axis comes down.
double first_range_m(const WalkSurroundings& around, const SimulatorOptions& options) {
  constexpr double far_above_m = 2.5;
  const Trajectory& poses = around.steps.poses;
  const Pose& middle = poses[poses.size() / 2].world_from_camera;
  const double above_m =
      middle.translation().z() - around.space.floor_beneath_m(middle.translation()) - chest_m;
  const Vector3d axis = middle.linear().col(2);
  if (above_m < far_above_m || axis.z() >= 0) return options.people_range_m;
  return std::max(options.people_range_m, above_m * axis.head<2>().norm() / -axis.z());
}

}  // namespace

WalkAhead::WalkAhead(const WalkSurroundings& around, const SimulatorOptions& options, int person,
                     std::uint64_t key)
    : around_(around) {
  constexpr double spacing = 0.3;  // people walk at different ranges
  constexpr double share_of_view = 0.75;
  constexpr double max_half_rad = 0.6;
  constexpr double crossing_speed_m_per_s = 1;  // in the middle of the picture
  const double half_view_rad = options.horizontal_fov_deg / 2 * std::numbers::pi / 180;
  range_m_ = first_range_m(around, options) * (1 + spacing * person);
  half_rad_ = std::min(max_half_rad, share_of_view * half_view_rad);
  period_s_ = 2 * std::numbers::pi * range_m_ * half_rad_ / crossing_speed_m_per_s;
  phase_rad_ = 2 * std::numbers::pi * share_of(key);
}

std::vector<WalkPlace> WalkAhead::places(int step) const {
  constexpr double half_angle_rad = 1.3;
  constexpr int angles = 25;
  constexpr int ranges = 13;
  constexpr double hidden_cost_per_s = 6;
  const StampedPose& camera = around_.steps.poses[static_cast<std::size_t>(step)];
  const Vector3d eye_m = camera.world_from_camera.translation();
  const double floor_m = around_.space.floor_beneath_m(eye_m);
  const Vector3d view = horizontal_view(camera.world_from_camera);
  const auto place_at = [&](double angle_rad, double range_m) {
    const Vector3d place =
        eye_m + range_m * (Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()) * view);
    return Vector3d(place.x(), place.y(), floor_m);
  };
  const double turn = 2 * std::numbers::pi * camera.timestamp_s / period_s_ + phase_rad_;
  const double wanted_range_m = range_m_ * (1 + range_swing * std::sin(range_pace * turn));
  const Vector3d wanted =
      place_at(half_rad_ * std::sin(turn), std::max(least_camera_gap_m, wanted_range_m));
  std::vector<WalkPlace> places;
  const auto add = [&](const Vector3d& near_m) {
    const auto place = around_.space.standing_place(near_m);
    if (!place) return;
    const Vector3d sight = *place + Vector3d(0, 0, chest_m) - eye_m;
    const bool is_hidden = around_.still.cast(eye_m, sight.normalized(), sight.norm()).has_value();
    places.push_back(
        {*place, cost_of_offset((*place - wanted).norm()) + (is_hidden ? hidden_cost_per_s : 0)});
  };
  add(wanted);
  for (int i = 0; i < angles * ranges; ++i) {
    const double angle_rad = half_angle_rad * (2.0 * (i % angles) / (angles - 1) - 1);
    const int of_range = i / angles;
    const double share = static_cast<double>(of_range) / (ranges - 1);
    const double range_m = range_m_ * (least_share + (largest_share - least_share) * share);
    if (range_m >= least_camera_gap_m) add(place_at(angle_rad, range_m));
  }
  return places;
}

}  // namespace tofmap
