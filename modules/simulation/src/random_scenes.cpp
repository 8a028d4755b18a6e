// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Random rooms, to which no method was tuned. The same seed gives the same room.

#include "builtin_scenes.hpp"
#include "random_draw.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// A random reflectance, from black cloth to white paint.
double reflectance(RandomDraw& draw) { return draw.log_between(0.1, 0.95); }

Vector3d place_on_floor(RandomDraw& draw, const Vector3d& room_m) {
  return {draw.between(0, room_m.x()), draw.between(0, room_m.y()), 0};
}

/// A box with a random yaw between the heights `bottom_m` and `top_m`.
TriangleMesh random_box(RandomDraw& draw, const Vector3d& room_m, double bottom_m, double top_m) {
  const Vector3d place = place_on_floor(draw, room_m);
  const Vector3d half(draw.log_between(0.05, 1), draw.log_between(0.05, 1), 0);
  TriangleMesh mesh;
  add_rotated_box(mesh, place - half + Vector3d(0, 0, bottom_m),
                  place + half + Vector3d(0, 0, top_m), draw.between(0, std::numbers::pi),
                  reflectance(draw));
  return mesh;
}

/// Adds a tilted board that stands on the floor.
void add_board(TriangleMesh& mesh, RandomDraw& draw, const Vector3d& room_m) {
  const double yaw = draw.between(0, 2 * std::numbers::pi);
  const double tilt = draw.between(0.1, 1.4);
  const Vector3d along = draw.between(0.4, 2) * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  const Vector3d up =
      draw.between(0.5, 2.2) *
      Vector3d(-std::sin(yaw) * std::cos(tilt), std::cos(yaw) * std::cos(tilt), std::sin(tilt));
  add_quad(mesh, place_on_floor(draw, room_m), along, up, reflectance(draw));
}

/// Adds a wall across part of the room, with a door or a window.
void add_partition(TriangleMesh& mesh, RandomDraw& draw, const Vector3d& room_m) {
  const Vector3d from = place_on_floor(draw, room_m);
  const double length_m = draw.between(1.5, 0.6 * room_m.y());
  const double yaw = draw.index(4) * std::numbers::pi / 2;
  const Vector3d to = from + length_m * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  const double top_m = draw.index(2) == 0 ? room_m.z() : draw.between(1.2, room_m.z());
  const double gap_m = draw.between(0.3, std::min(1.2, length_m - 0.8));
  const double begin_m = draw.between(0.2, length_m - gap_m - 0.2);
  const double sill_m = draw.index(2) == 0 ? 0 : 0.9;
  const WallOpening opening{begin_m, begin_m + gap_m, sill_m, std::min(2.1, top_m)};
  add_wall(mesh, from, to, top_m, 0.12, {opening}, reflectance(draw));
}

/// Only boxes on the floor are furniture, which can be rearranged.
void add_thing(Scene& scene, RandomDraw& draw, const Vector3d& room_m) {
  TriangleMesh& mesh = scene.surface;
  switch (draw.index(8)) {
    case 0:
      add_cylinder(mesh, place_on_floor(draw, room_m), draw.log_between(0.03, 0.4), room_m.z(),
                   reflectance(draw));
      break;
    case 1:  // hangs from the ceiling
      add_mesh(mesh, random_box(draw, room_m, draw.between(0.7, 0.97) * room_m.z(), room_m.z()));
      break;
    case 2:  // table top or shelf
      add_mesh(mesh, random_box(draw, room_m, 0.72, 0.76));
      break;
    case 3:
      add_board(mesh, draw, room_m);
      break;
    case 4:
      add_partition(mesh, draw, room_m);
      break;
    default:
      add_piece(scene, "box", random_box(draw, room_m, 0, draw.log_between(0.2, 2.4)));
  }
}

/// A place at about eye height for the camera: the best of 100 random places, which has free space
/// around it and is far from the middle of the room.
Vector3d free_place(RandomDraw& draw, const RayScene& rays, const Vector3d& room_m) {
  constexpr double wanted_m = 0.9;
  Vector3d best = room_m / 2;
  double best_score = 0;
  for (int attempt = 0; attempt < 100; ++attempt) {
    Vector3d place = place_on_floor(draw, room_m);
    place.z() = draw.between(1, std::min(2.2, room_m.z() - 0.5));
    const double from_middle_m = (place - room_m / 2).head<2>().norm();
    const double score = std::pow(rays.clearance_m(place, wanted_m), 3) * from_middle_m;
    if (score > best_score) {
      best_score = score;
      best = place;
    }
  }
  return best;
}

/// A closed path near `place` that looks across the room, from side to side.
CameraPath look_across(RandomDraw& draw, const Vector3d& place, const Vector3d& room_m) {
  const Vector3d across = room_m / 2 - place;
  const double middle = std::atan2(across.y(), across.x());
  const double pitch = draw.between(-0.25, 0.15);
  std::vector<Waypoint> waypoints;
  constexpr int count = 12;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * std::numbers::pi * i / count;
    const double yaw = middle + 1.1 * std::sin(turn);
    const Vector3d ahead(std::cos(yaw), std::sin(yaw), pitch + 0.2 * std::cos(2 * turn));
    waypoints.push_back({place + 0.3 * Vector3d(std::cos(turn), std::sin(turn), 0), ahead});
  }
  return {std::move(waypoints), true};
}

}  // namespace

Scene random_scene(int seed) {
  RandomDraw draw(seed, 0x726f6f6dULL);
  const Vector3d room_m(draw.log_between(6, 30), draw.log_between(5, 20), draw.log_between(2.5, 8));
  Scene scene{.name = "random", .min_frames = 120};
  add_hull(scene.surface, room_m, draw.between(0.15, 0.8), draw.between(0.3, 0.9),
           draw.between(0.3, 0.85));
  const int things = 6 + draw.index(20);
  for (int i = 0; i < things; ++i) add_thing(scene, draw, room_m);
  const RayScene rays(scene.surface);
  scene.path = look_across(draw, free_place(draw, rays, room_m), room_m);
  scene.max_range_m = room_m.norm() + 0.1;
  return scene;
}

}  // namespace tofmap
