// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/door.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// Adds a box in the frame of a leaf: x from the hinge along the leaf, y across it, z up.
void add_part(TriangleMesh& mesh, const Door& door, double angle_rad, const Vector3d& min,
              const Vector3d& max, double reflectance) {
  const Vector3d along = door.leaf_direction(angle_rad);
  const Vector3d across = Vector3d::UnitZ().cross(along);
  const Vector3d middle = (min + max) / 2;
  const Vector3d centre =
      door.hinge_m + middle.x() * along + middle.y() * across + Vector3d(0, 0, middle.z());
  const Vector3d half = (max - min) / 2;
  add_rotated_box(mesh, centre - half, centre + half, std::atan2(along.y(), along.x()),
                  reflectance);
}

}  // namespace

double Door::angle_at(double time_s) const {
  double share = is_open_at_first ? 1 : 0;
  bool opens = !is_open_at_first;
  for (const double start_s : swings_s) {
    const double t = std::clamp((time_s - start_s) / swing_s, 0.0, 1.0);
    const double done = t * t * (3 - 2 * t);
    share = (1 - done) * share + done * (opens ? 1 : 0);
    opens = !opens;
  }
  return open_rad * share;
}

Vector3d Door::leaf_direction(double angle_rad) const {
  const double direction_rad = shut_rad + side * angle_rad;
  return {std::cos(direction_rad), std::sin(direction_rad), 0};
}

void add_leaf(TriangleMesh& mesh, const Door& door, double time_s) {
  constexpr double gap_m = 0.01;  // to floor and frame
  constexpr double half_m = Door::thickness_m / 2;
  const double angle_rad = door.angle_at(time_s);
  add_part(mesh, door, angle_rad, {0, -half_m, gap_m},
           {Door::width_m, half_m, door.height_m - gap_m}, door.reflectance);
  constexpr double handle_m = 1.05;
  constexpr double handle_reach_m = 0.05;
  const double handle_reflectance = 0.3;
  for (const double side : {-1.0, 1.0}) {
    const double from = side * half_m;
    const double to = side * (half_m + handle_reach_m);
    add_part(mesh, door, angle_rad, {Door::width_m - 0.18, std::min(from, to), handle_m},
             {Door::width_m - 0.06, std::max(from, to), handle_m + 0.03}, handle_reflectance);
  }
}

void add_frame(TriangleMesh& mesh, const Door& door) {
  constexpr double gap_m = 0.03;  // to the leaf, which may turn about its middle
  constexpr double bar_m = 0.07;
  constexpr double shut = 0;
  constexpr double half_m = Door::thickness_m / 2;
  // The wall is on the side to which the leaf does not open.
  const double y0 = std::min(-door.side * Door::off_wall_m, door.side * half_m);
  const double y1 = std::max(-door.side * Door::off_wall_m, door.side * half_m);
  const double edge_m = Door::width_m + gap_m;
  const double reflectance = std::min(1.0, door.reflectance + 0.15);
  const auto bar = [&](double x0, double x1, double z0, double z1) {
    add_part(mesh, door, shut, {x0, y0, z0}, {x1, y1, z1}, reflectance);
  };
  bar(-gap_m - bar_m, -gap_m, 0, door.height_m + bar_m);
  bar(edge_m, edge_m + bar_m, 0, door.height_m + bar_m);
  bar(-gap_m, edge_m, door.height_m, door.height_m + bar_m);
}

}  // namespace tofmap
