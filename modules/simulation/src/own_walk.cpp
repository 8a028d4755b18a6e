// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "own_walk.hpp"

#include "noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double least_line_m = 2;
constexpr double longest_line_m = 6;
constexpr double line_spacing_m = 1.5;  ///< between the middles of two lines

/// The end of the longest free line from a place in a horizontal direction.
Vector3d end_of_line(const StandingSpace& space, const Vector3d& from, const Vector3d& direction) {
  constexpr double step_m = 0.05;
  double free_m = 0;
  while (free_m < longest_line_m && space.standing_place(from + (free_m + step_m) * direction)) {
    free_m += step_m;
  }
  return from + free_m * direction;
}

/// How large and how long people on a line are in the picture.
double visibility_of_line(const WalkSurroundings& around, const Vector3d& from,
                          const Vector3d& to) {
  double sum = 0;
  for (const double share : {0.0, 0.5, 1.0}) {
    const Vector3d chest = from + share * (to - from) + Vector3d(0, 0, chest_m);
    sum += visibility(around.steps, around.camera, around.still, chest);
  }
  return sum;
}

}  // namespace

OwnWalk::OwnWalk(const WalkSurroundings& around, const Vector3d& from, const Vector3d& to,
                 std::uint64_t key)
    : around_(around),
      from_(from),
      to_(to),
      speed_m_per_s_(0.8 + 0.6 * share_of(key)),
      phase_(share_of(key + 1)) {
  constexpr double spacing_m = 0.2;
  constexpr double aside_m = 1.2;
  constexpr double beyond_m = 3;
  const Vector3d along = (to - from).normalized();
  const Vector3d across = Vector3d::UnitZ().cross(along);
  const int beyond = static_cast<int>(std::lround(beyond_m / spacing_m));
  const int length = static_cast<int>((to - from).norm() / spacing_m);
  const int width = static_cast<int>(std::lround(aside_m / spacing_m));
  for (int i = -beyond; i <= length + beyond; ++i) {
    for (int j = -width; j <= width; ++j) {
      const auto place =
          around.space.standing_place(from + i * spacing_m * along + j * spacing_m * across);
      if (place) places_.push_back(*place);
    }
  }
}

Vector3d OwnWalk::wanted(double time_s) const {
  const double round_s = 2 * (to_ - from_).norm() / speed_m_per_s_;
  const double turn = time_s / round_s + phase_;
  const double share = std::abs(2 * (turn - std::floor(turn)) - 1);
  return from_ + share * (to_ - from_);
}

std::vector<WalkPlace> OwnWalk::places(int step) const {
  constexpr double polite_gap_m = 2;
  constexpr double nearness_cost_per_s = 60;
  const StampedPose& camera = around_.steps.poses[static_cast<std::size_t>(step)];
  const Vector3d eye_m = camera.world_from_camera.translation();
  const Vector3d target = wanted(camera.timestamp_s);
  std::vector<WalkPlace> places;
  const auto add = [&](const Vector3d& place) {
    const double gap_m = (place - eye_m).head<2>().norm();
    if (gap_m < least_camera_gap_m) return;
    const double nearness = std::max(0.0, polite_gap_m - gap_m) / polite_gap_m;
    places.push_back({place, cost_of_offset((place - target).norm()) +
                                 nearness_cost_per_s * nearness * nearness});
  };
  add(target);
  for (const Vector3d& place : places_) add(place);
  return places;
}

std::optional<OwnWalk> find_own_walk(const WalkSurroundings& around,
                                     const std::vector<OwnWalk>& others, std::uint64_t key) {
  constexpr double spacing_m = 0.6;
  constexpr int directions = 8;  // the other eight are those of the line's other end
  std::optional<std::pair<Vector3d, Vector3d>> best;
  double best_worth = 0;
  std::uint64_t line = 0;
  for (const Vector3d& from : around.space.free_places(spacing_m)) {
    for (int i = 0; i < directions; ++i) {
      const double angle_rad = std::numbers::pi * i / directions;
      const Vector3d to =
          end_of_line(around.space, from, {std::cos(angle_rad), std::sin(angle_rad), 0});
      const Vector3d middle = (from + to) / 2;
      const double chance = 0.5 + share_of(key + 2 + line++);
      const bool is_near_another = std::ranges::any_of(others, [&](const OwnWalk& other) {
        return (other.middle() - middle).norm() < line_spacing_m;
      });
      if (is_near_another || (to - from).norm() < least_line_m) continue;
      const double worth = chance * visibility_of_line(around, from, to);
      if (worth <= best_worth) continue;
      best_worth = worth;
      best = {from, to};
    }
  }
  if (!best) return std::nullopt;
  return OwnWalk(around, best->first, best->second, key);
}

}  // namespace tofmap
