// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frozen.hpp"

#include <cmath>
#include <random>

namespace tofmap::accuracy::frozen {
namespace {

using Eigen::Vector3d;

/// Adds a beam of square cross-section between two points. It must not be vertical.
void add_beam(TriangleMesh& mesh, const Vector3d& from, const Vector3d& to, double thickness_m,
              double reflectance) {
  const Vector3d along = to - from;
  const Vector3d side = along.cross(Vector3d::UnitZ()).normalized() * thickness_m;
  const Vector3d up = side.cross(along).normalized() * thickness_m;
  const Vector3d corner = from - side / 2 - up / 2;
  add_quad(mesh, corner, along, side, reflectance);
  add_quad(mesh, corner + up, along, side, reflectance);
  add_quad(mesh, corner, along, up, reflectance);
  add_quad(mesh, corner + side, along, up, reflectance);
}

void add_room(TriangleMesh& mesh, const Vector3d& size_m, double floor, double ceiling,
              double walls) {
  const Vector3d x(size_m.x(), 0, 0);
  const Vector3d y(0, size_m.y(), 0);
  const Vector3d z(0, 0, size_m.z());
  add_quad(mesh, Vector3d::Zero(), x, y, floor);
  add_quad(mesh, z, x, y, ceiling);
  add_quad(mesh, Vector3d::Zero(), x, z, walls);
  add_quad(mesh, y, x, z, walls);
  add_quad(mesh, Vector3d::Zero(), y, z, walls);
  add_quad(mesh, x, y, z, walls);
}

Scene attic() {
  Scene scene{.name = "attic", .min_frames = 120, .max_range_m = 18};
  constexpr double length = 14, width = 8, eaves = 0.9, ridge = 4.6;
  TriangleMesh& mesh = scene.surface;
  const Vector3d along(length, 0, 0);
  add_quad(mesh, {0, 0, 0}, along, {0, width, 0}, 0.35);
  add_quad(mesh, {0, 0, 0}, along, {0, 0, eaves}, 0.5);
  add_quad(mesh, {0, width, 0}, along, {0, 0, eaves}, 0.5);
  add_quad(mesh, {0, 0, eaves}, along, {0, width / 2, ridge - eaves}, 0.25);
  add_quad(mesh, {0, width, eaves}, along, {0, -width / 2, ridge - eaves}, 0.25);
  add_quad(mesh, {0, 0, 0}, {0, width, 0}, {0, 0, ridge}, 0.6);
  add_quad(mesh, {length, 0, 0}, {0, width, 0}, {0, 0, ridge}, 0.6);
  for (double x = 2; x < length; x += 2.5) {
    add_beam(mesh, {x, 0.4, eaves}, {x, width / 2, ridge - 0.35}, 0.14, 0.45);
    add_beam(mesh, {x, width - 0.4, eaves}, {x, width / 2, ridge - 0.35}, 0.14, 0.45);
    add_beam(mesh, {x, 1.9, 2.5}, {x, width - 1.9, 2.5}, 0.16, 0.45);
  }
  add_rotated_box(mesh, {6.4, 3.6, 0}, {7.2, 4.4, 4.4}, 0.3, 0.3);
  add_rotated_box(mesh, {11.0, 5.2, 0}, {12.2, 6.0, 1.0}, 0.9, 0.8);
  add_rotated_box(mesh, {3.0, 1.2, 0}, {4.4, 1.9, 0.7}, 2.0, 0.15);
  add_rotated_box(mesh, {9.4, 1.0, 0}, {10.0, 1.8, 1.4}, 0.4, 0.55);
  add_cylinder(mesh, {2.2, 6.4, 0}, 0.35, 1.2, 0.1);
  scene.path = CameraPath(
      {look_at({1.2, 4.0, 1.5}, {12, 4.6, 1.4}), look_at({4.0, 3.0, 1.5}, {13, 6.0, 1.2}),
       look_at({7.0, 2.6, 1.6}, {14, 3.0, 1.5}), look_at({10.6, 3.4, 1.5}, {11, 8.0, 1.0}),
       look_at({10.0, 4.8, 1.6}, {2, 5.0, 1.6}), look_at({6.8, 5.4, 1.5}, {0, 3.0, 1.2}),
       look_at({3.2, 4.6, 1.5}, {0, 1.0, 0.8})},
      true);
  return scene;
}

/// Adds a rack along x: uprights, boards, and boxes of random sizes and reflectances on the boards.
void add_rack(TriangleMesh& mesh, const Vector3d& foot, double length_m, std::mt19937& random) {
  constexpr double depth = 1.0, spacing = 1.5;
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (double x = 0; x <= length_m + 0.01; x += 2.5) {
    for (const double y : {0.0, depth - 0.08}) {
      const Vector3d corner = foot + Vector3d(x, y, 0);
      add_box(mesh, corner, corner + Vector3d(0.08, 0.08, 4.8), 0.3);
    }
  }
  for (int level = 1; level <= 3; ++level) {
    const Vector3d corner = foot + Vector3d(0, 0, level * spacing);
    add_box(mesh, corner, corner + Vector3d(length_m, depth, 0.05), 0.4);
  }
  for (int level = 0; level <= 3; ++level) {
    for (double x = 0.2; x < length_m - 1.2; x += draw(0.9, 2.2)) {
      const Vector3d corner = foot + Vector3d(x, draw(0.02, 0.3), level * spacing + 0.05);
      const Vector3d size(draw(0.4, 0.9), draw(0.3, 0.65), draw(0.2, 1.1));
      add_box(mesh, corner, corner + size, draw(0.05, 0.85));
    }
  }
}

Scene depot() {
  Scene scene{.name = "depot", .min_frames = 120, .max_range_m = 36};
  std::mt19937 random(first_seed);
  add_room(scene.surface, {30, 18, 6.5}, 0.25, 0.15, 0.3);
  for (const double y : {3.0, 7.5, 12.5}) add_rack(scene.surface, {5, y, 0}, 18, random);
  for (const double x : {2.5, 26.5}) {
    add_cylinder(scene.surface, {x, 3.5, 0}, 0.3, 0.9, 0.6);
    add_cylinder(scene.surface, {x, 14.5, 0}, 0.45, 1.6, 0.1);
  }
  scene.path = CameraPath(
      {look_at({2.5, 5.8, 1.6}, {29, 6.0, 1.8}), look_at({8.0, 5.9, 1.6}, {29, 5.4, 1.4}),
       look_at({15.0, 5.8, 1.6}, {26, 8.0, 2.0}), look_at({22.0, 5.8, 1.6}, {29, 12.0, 1.5}),
       look_at({26.0, 8.5, 1.6}, {20, 18.0, 1.5}), look_at({25.5, 10.8, 1.6}, {1, 10.4, 2.5}),
       look_at({18.0, 10.6, 1.6}, {1, 10.8, 1.5}), look_at({9.0, 10.6, 1.6}, {0, 6.0, 1.5}),
       look_at({3.0, 8.6, 1.6}, {0, 2.0, 1.0})},
      true);
  return scene;
}

Scene workshop() {
  Scene scene{.name = "workshop", .min_frames = 120, .max_range_m = 9.8};
  TriangleMesh& mesh = scene.surface;
  add_room(mesh, {7.5, 5.5, 3}, 0.2, 0.8, 0.65);
  add_cylinder(mesh, {1.0, 4.4, 0}, 0.6, 2.2, 0.9);
  add_cylinder(mesh, {2.4, 4.7, 0}, 0.4, 1.8, 0.15);
  add_cylinder(mesh, {6.6, 0.9, 0}, 0.5, 2.6, 0.5);
  add_rotated_box(mesh, {3.2, 2.4, 0}, {4.4, 3.2, 1.1}, 0.5, 0.35);
  add_rotated_box(mesh, {5.6, 4.2, 0}, {6.8, 4.9, 1.9}, 0.15, 0.1);
  add_rotated_box(mesh, {0.4, 0.4, 0}, {2.6, 1.0, 0.9}, 0.05, 0.75);
  add_box(mesh, {3.6, 0.0, 1.2}, {5.2, 0.35, 2.0}, 0.05);
  for (double x = 3.3; x < 5.4; x += 0.3) add_cylinder(mesh, {x, 5.3, 0.9}, 0.04, 1.2, 0.7);
  scene.path =
      CameraPath({look_at({2.2, 2.0, 1.5}, {7, 4.0, 1.2}), look_at({3.6, 1.5, 1.5}, {7, 5.0, 1.0}),
                  look_at({5.4, 2.0, 1.4}, {4, 5.5, 1.2}), look_at({5.2, 3.4, 1.5}, {0, 5.0, 1.2}),
                  look_at({3.8, 4.0, 1.5}, {0, 1.0, 1.0}), look_at({2.4, 3.2, 1.5}, {4, 0.0, 1.4})},
                 true);
  return scene;
}

}  // namespace

Scene make_scene(const std::string& name, int seed) {
  if (name == "attic") return attic();
  if (name == "depot") return depot();
  if (name == "workshop") return workshop();
  return tofmap::make_scene(name, seed);
}

}  // namespace tofmap::accuracy::frozen
