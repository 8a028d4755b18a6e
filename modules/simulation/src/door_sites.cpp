// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "door_sites.hpp"

#include "noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;
constexpr double handle_height_m = 1.1;
constexpr double door_height_m = 2;
constexpr double hinge_gap_m = 2;  ///< between the hinges of two doors
constexpr double camera_gap_m = 0.35;

/// Heights at which rays are cast past a leaf.
constexpr std::array<double, 5> heights_m{0.12, 0.6, handle_height_m, 1.55, 1.95};

Vector3d lifted(const Vector3d& foot_m, double height_m) {
  return foot_m + Vector3d(0, 0, height_m);
}

/// Whether a shut leaf with its frame fits in front of the wall: the wall is behind the hinge and
/// behind the lower part of the other jamb, and nothing protrudes as far as the leaf.
bool hangs_flat(const RayScene& still, const Door& door) {
  constexpr double ahead_m = 0.3;
  constexpr double tolerance_m = 0.02;
  constexpr double low_m = 0.8;
  const Vector3d along = door.leaf_direction(0);
  const Vector3d from_wall = door.side * Vector3d::UnitZ().cross(along);
  for (const double height_m : heights_m) {
    for (int i = 0; i <= 5; ++i) {
      const double x_m = i == 0 ? -0.1 : (i - 1) * (Door::width_m + 0.1) / 4;
      const Vector3d origin = lifted(door.hinge_m + x_m * along + ahead_m * from_wall, height_m);
      const double to_wall_m = ahead_m + Door::off_wall_m;
      const auto hit = still.cast(origin, -from_wall, to_wall_m + tolerance_m);
      if (hit && hit->range_m < to_wall_m - tolerance_m / 4) return false;
      if (!hit && (i <= 1 || (i == 5 && height_m < low_m))) return false;
    }
  }
  return true;
}

/// The largest angle up to which the leaf swings without meeting a surface.
double free_swing_rad(const RayScene& still, const Door& door) {
  constexpr double step_rad = 4 * degree;
  constexpr double most_rad = 88 * degree;
  constexpr double margin_m = 0.05;
  double free_rad = 0;
  for (double angle_rad = step_rad; angle_rad <= most_rad; angle_rad += step_rad) {
    const Vector3d along = door.leaf_direction(angle_rad);
    for (const double height_m : heights_m) {
      const Vector3d origin = lifted(door.hinge_m + margin_m * along, height_m);
      if (still.cast(origin, along, Door::width_m)) return free_rad;
    }
    const Vector3d edge = lifted(door.hinge_m + Door::width_m * along, heights_m.front());
    if (still.cast(edge, Vector3d::UnitZ(), door_height_m)) return free_rad;
    free_rad = angle_rad;
  }
  return free_rad;
}

bool stands_on_floor(const RayScene& still, const StandingSpace& space, const Door& door) {
  if (!space.has_floor()) return true;
  constexpr double tolerance_m = 0.03;
  const Vector3d middle = door.hinge_m + Door::width_m / 2 * door.leaf_direction(door.open_rad / 2);
  const auto hit = still.cast(lifted(middle, handle_height_m), -Vector3d::UnitZ(),
                              handle_height_m + tolerance_m);
  return hit && std::abs(hit->range_m - handle_height_m) < tolerance_m;
}

bool keeps_clear_of_camera(const Door& door, const CameraSteps& steps) {
  return std::ranges::none_of(steps.poses, [&](const StampedPose& pose) {
    const Vector3d away = pose.world_from_camera.translation() - door.hinge_m;
    return away.head<2>().norm() < Door::width_m + camera_gap_m;
  });
}

/// A point near the middle of the half-open leaf.
Vector3d leaf_middle(const Door& door) {
  const Vector3d along = door.leaf_direction(door.open_rad / 2);
  return lifted(door.hinge_m + Door::width_m / 2 * along, handle_height_m);
}

/// The door whose hinge is at the point of a wall that a horizontal ray meets. `side` says on which
/// side of the point the leaf is. Empty if there is no room for it.
std::optional<Door> door_at(const RayScene& still, const StandingSpace& space,
                            const CameraSteps& steps, const Vector3d& origin,
                            const Vector3d& direction, double side) {
  constexpr double reach_m = 15;
  constexpr double least_swing_rad = 60 * degree;
  constexpr double upright = 0.02;  // largest vertical part of the normal of a wall
  const auto hit = still.cast(origin, direction, reach_m);
  if (!hit || std::abs(hit->normal.z()) > upright) return std::nullopt;
  const Vector3d from_wall = hit->normal.dot(direction) < 0 ? hit->normal : -hit->normal;
  const Vector3d along = side * from_wall.cross(Vector3d::UnitZ());
  Door door;
  door.hinge_m = origin + hit->range_m * direction + Door::off_wall_m * from_wall;
  door.hinge_m.z() = origin.z() - handle_height_m;
  door.shut_rad = std::atan2(along.y(), along.x());
  door.side = side;
  door.height_m = door_height_m;
  if (!keeps_clear_of_camera(door, steps) || !hangs_flat(still, door)) return std::nullopt;
  door.open_rad = free_swing_rad(still, door);
  if (door.open_rad < least_swing_rad || !stands_on_floor(still, space, door)) return std::nullopt;
  return door;
}

/// The doors for which there is room, as seen from places along the path.
std::vector<Door> possible_doors(const RayScene& still, const StandingSpace& space,
                                 const CameraSteps& steps) {
  constexpr int places = 60;
  constexpr int directions = 24;
  std::vector<Door> doors;
  const int stride = std::max(1, steps.count() / places);
  for (int i = 0; i < steps.count(); i += stride) {
    Vector3d origin = steps.poses[static_cast<std::size_t>(i)].world_from_camera.translation();
    origin.z() = space.floor_beneath_m(origin) + handle_height_m;
    for (int j = 0; j < directions; ++j) {
      const double angle_rad = 2 * std::numbers::pi * (j + 0.5 * (i % 2)) / directions;
      const Vector3d direction(std::cos(angle_rad), std::sin(angle_rad), 0);
      for (const double side : {1.0, -1.0}) {
        const auto door = door_at(still, space, steps, origin, direction, side);
        if (door) doors.push_back(*door);
      }
    }
  }
  return doors;
}

/// When a door begins to swing: a while after it comes into view, and again and again as long as it
/// stays there.
std::vector<double> swings_while_seen(const CameraSteps& steps, const std::vector<bool>& seen,
                                      std::uint64_t key) {
  const double span_s = (steps.count() - 1) * steps.step_s;
  const double rest_s = std::min(1.5, 0.2 * span_s);  // seen at rest before it swings
  constexpr double least_pause_s = 3;
  constexpr double extra_pause_s = 2;
  std::vector<double> swings_s;
  double seen_s = 0;
  double next_s = steps.start_s();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double time_s = steps.poses[i].timestamp_s;
    seen_s = seen[i] ? seen_s + steps.step_s : 0;
    if (seen_s < rest_s || time_s < next_s) continue;
    swings_s.push_back(time_s);
    next_s = time_s + Door::swing_s + least_pause_s + extra_pause_s * share_of(key + i);
  }
  return swings_s;
}

}  // namespace

std::vector<Door> hang_doors(const RayScene& still, const StandingSpace& space,
                             const CameraSteps& steps, const CameraModel& camera, int count,
                             int seed) {
  struct Offer {
    Door door;
    double worth;
  };
  const std::uint64_t key = mix(mix(static_cast<std::uint64_t>(seed)) + 1000);
  std::vector<Offer> offers;
  for (const Door& door : possible_doors(still, space, steps)) {
    const double chance = 0.5 + share_of(key + offers.size());
    offers.push_back({door, chance * visibility(steps, camera, still, leaf_middle(door))});
  }
  std::vector<Door> doors;
  for (int i = 0; i < count && !offers.empty(); ++i) {
    const auto best = std::ranges::max_element(offers, {}, &Offer::worth);
    if (best->worth == 0) break;
    Door door = best->door;
    const std::uint64_t own_key = mix(key + static_cast<unsigned>(i));
    door.reflectance = 0.3 + 0.5 * share_of(own_key);
    door.is_open_at_first = share_of(own_key + 1) < 0.5;
    door.swings_s = swings_while_seen(
        steps, steps_that_see(steps, camera, still, leaf_middle(door)), own_key + 2);
    std::erase_if(offers, [&](const Offer& offer) {
      return (offer.door.hinge_m - door.hinge_m).norm() < hinge_gap_m;
    });
    doors.push_back(std::move(door));
  }
  return doors;
}

}  // namespace tofmap
