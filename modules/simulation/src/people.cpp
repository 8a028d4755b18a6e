// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "people.hpp"

#include "noise.hpp"
#include "standing_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double chest_m = 1.2;               ///< height over the floor
constexpr double least_camera_gap_m = 0.65;   ///< from the camera to the middle of a person
constexpr double least_person_gap_m = 0.65;   ///< between the middles of two people
constexpr double crossing_speed_m_per_s = 1;  ///< sideways, in the middle of the picture

/// What people plan their walks with: the poses of the camera at evenly spaced times, and where one
/// can stand.
struct Surroundings {
  const RayScene& still;
  const StandingSpace& space;
  Trajectory camera;
  double step_s;
};

/// The horizontal direction in which the camera looks. If it looks down, that to the upper edge of
/// its image.
Vector3d horizontal_view(const Pose& world_from_camera) {
  constexpr double share_of_up = 0.2;
  const Eigen::Matrix3d axes = world_from_camera.linear();
  Vector3d view = axes.col(2) - share_of_up * axes.col(1);
  view.z() = 0;
  return view.norm() > 1e-6 ? view.normalized() : Vector3d(Vector3d::UnitX());
}

/// Poses at evenly spaced times: a step before the first pose to a step after the last, and beyond
/// the ends as if the motion went on.
Trajectory evenly_spaced(const Trajectory& poses, double step_s) {
  const double start_s = poses.front().timestamp_s - step_s;
  const double span_s = poses.back().timestamp_s + step_s - start_s;
  const int count = static_cast<int>(std::ceil(span_s / step_s - 1e-9)) + 1;
  Trajectory even;
  std::size_t next = 1;
  for (int i = 0; i < count; ++i) {
    const double time_s = start_s + i * step_s;
    while (next + 1 < poses.size() && poses[next].timestamp_s < time_s) ++next;
    if (poses.size() == 1) {
      even.push_back({time_s, poses[0].world_from_camera});
      continue;
    }
    const StampedPose& a = poses[next - 1];
    const StampedPose& b = poses[next];
    const double share = (time_s - a.timestamp_s) / (b.timestamp_s - a.timestamp_s);
    even.push_back({time_s, interpolate(a.world_from_camera, b.world_from_camera,
                                        std::clamp(share, -1.0, 2.0))});
  }
  return even;
}

/// The look of a person, drawn by a key.
PersonLook drawn_look(std::uint64_t key) {
  const auto between = [&key](double low, double high) {
    return low + (high - low) * share_of(key++);
  };
  return {.height_m = between(1.6, 1.9),
          .skin = between(0.5, 0.7),
          .hair = between(0.08, 0.4),
          .shirt = between(0.15, 0.85),
          .trousers = between(0.08, 0.5),
          .shoes = between(0.05, 0.3)};
}

bool keeps_clear(const std::vector<WalkedPlaces>& others, std::size_t step,
                 const Vector3d& foot_m) {
  return std::ranges::none_of(others, [&](const WalkedPlaces& other) {
    return other[step] && (*other[step] - foot_m).norm() < least_person_gap_m;
  });
}

bool keeps_clear_of_camera(const Pose& world_from_camera, const Vector3d& foot_m) {
  return (world_from_camera.translation() - foot_m).head<2>().norm() >= least_camera_gap_m;
}

/// Someone who walks to and fro ahead of the camera.
struct AheadWalk {
  double range_m;    ///< from the camera, on average
  double half_rad;   ///< to each side
  double period_s;   ///< of the walk to and fro
  double phase_rad;  ///< of that walk at the time 0

  /// Where the person wants to be, in polar coordinates around the camera: angle to the left of the
  /// viewing direction, and range.
  std::pair<double, double> wanted(double time_s) const {
    constexpr double range_swing = 0.25;
    const double turn = 2 * std::numbers::pi * time_s / period_s + phase_rad;
    return {half_rad * std::sin(turn), range_m * (1 + range_swing * std::sin(0.37 * turn))};
  }
};

/// The places around the camera, with the square of their offset from the wanted place as cost.
std::vector<WalkPlace> places_ahead(const Surroundings& around, const AheadWalk& walk, int step) {
  constexpr double half_angle_rad = 1.3;
  constexpr int angles = 25;
  constexpr int ranges = 13;
  constexpr double tolerated_m = 0.5;
  constexpr double hidden_cost_per_s = 6;
  const StampedPose& camera = around.camera[static_cast<std::size_t>(step)];
  const Vector3d eye_m = camera.world_from_camera.translation();
  const double floor_m = around.space.floor_beneath_m(eye_m);
  const Vector3d view = horizontal_view(camera.world_from_camera);
  const auto place_at = [&](double angle_rad, double range_m) {
    Vector3d place = eye_m + range_m * (Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()) * view);
    place.z() = floor_m;
    return place;
  };
  const auto [wanted_rad, wanted_m] = walk.wanted(camera.timestamp_s);
  const Vector3d wanted = place_at(wanted_rad, wanted_m);
  std::vector<WalkPlace> places;
  for (int i = 0; i < angles * ranges; ++i) {
    const double angle_rad = half_angle_rad * (2.0 * (i % angles) / (angles - 1) - 1);
    const double share = static_cast<double>(i / angles) / (ranges - 1);
    const Vector3d place = place_at(angle_rad, walk.range_m * (0.4 + 1.2 * share));
    if (!keeps_clear_of_camera(camera.world_from_camera, place) || !around.space.is_free(place)) {
      continue;
    }
    const Vector3d sight = place + Vector3d(0, 0, chest_m) - eye_m;
    const bool is_hidden = around.still.cast(eye_m, sight.normalized(), sight.norm()).has_value();
    const double off = (place - wanted).norm() / tolerated_m;
    places.push_back({place, off * off + (is_hidden ? hidden_cost_per_s : 0)});
  }
  return places;
}

WalkedPlaces walk_ahead(const Surroundings& around, const AheadWalk& wish,
                        const std::vector<WalkedPlaces>& others) {
  const auto places = [&](int step) {
    std::vector<WalkPlace> all = places_ahead(around, wish, step);
    std::erase_if(all, [&](const WalkPlace& place) {
      return !keeps_clear(others, static_cast<std::size_t>(step), place.foot_m);
    });
    return all;
  };
  WalkedPlaces walk = cheapest_walk(static_cast<int>(around.camera.size()), around.step_s, places);
  smooth_walk(walk, [&](int step, const Vector3d& foot_m) {
    const auto i = static_cast<std::size_t>(step);
    return around.space.is_free(foot_m) && keeps_clear(others, i, foot_m) &&
           keeps_clear_of_camera(around.camera[i].world_from_camera, foot_m);
  });
  return walk;
}

AheadWalk wish_ahead(const SimulatorOptions& options, int person, std::uint64_t key) {
  constexpr double share_of_view = 0.75;
  constexpr double max_half_rad = 0.6;
  constexpr double spacing = 0.3;  // people walk at different ranges
  AheadWalk walk;
  walk.range_m = options.people_range_m * (1 + spacing * person);
  walk.half_rad = std::min(max_half_rad,
                           share_of_view * options.horizontal_fov_deg / 2 * std::numbers::pi / 180);
  walk.period_s = 2 * std::numbers::pi * walk.range_m * walk.half_rad / crossing_speed_m_per_s;
  walk.phase_rad = 2 * std::numbers::pi * share_of(key);
  return walk;
}

}  // namespace

std::vector<Walker> walking_people(const RayScene& still, const Trajectory& camera,
                                   const SimulatorOptions& options) {
  std::vector<Walker> people;
  if (options.people == 0) return people;
  constexpr double usual_step_s = 0.1;
  constexpr double max_steps = 20000;
  const double span_s = camera.back().timestamp_s - camera.front().timestamp_s;
  const double step_s = std::max(usual_step_s, span_s / max_steps);
  const double reach_m = 2 * options.people_range_m + 3;
  const StandingSpace space(still, camera, reach_m);
  const Surroundings around{still, space, evenly_spaced(camera, step_s), step_s};
  std::vector<WalkedPlaces> walks;
  for (int person = 0; person < options.people; ++person) {
    const std::uint64_t key = mix(mix(static_cast<std::uint64_t>(options.seed)) + person + 77);
    walks.push_back(walk_ahead(around, wish_ahead(options, person, key + 100), walks));
    people.emplace_back(drawn_look(key), walks.back(), around.camera.front().timestamp_s, step_s);
  }
  return people;
}

}  // namespace tofmap
