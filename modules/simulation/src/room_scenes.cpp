// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Furnished places for mapping.

#include "builtin_scenes.hpp"
#include "furniture_shapes.hpp"

#include <cmath>
#include <numbers>

namespace tofmap {

using Eigen::Vector3d;

namespace {

void furnish_room(Scene& scene) {
  const int on_wall = FurniturePiece::on_wall;
  add_piece(scene, "shelf", shelf_shape({0.6, 0.02, 0}, {2.6, 0.42, 2.1}, true, 0.6));
  add_piece(scene, "shelf", shelf_shape({8.6, 8.58, 0}, {10.8, 8.98, 2.2}, false, 0.5));
  add_piece(scene, "wardrobe", box_shape({3.4, 0.02, 0}, {4.6, 0.62, 1.9}, 0.75));
  add_piece(scene, "sofa", sofa_shape({5.4, 0.05, 0}, {7.6, 0.95, 0.85}, 0.35));
  add_piece(scene, "chest of drawers", box_shape({8.4, 0.02, 0}, {9.6, 0.5, 0.9}, 0.65));
  add_piece(scene, "cupboard", box_shape({11.35, 1.5, 0}, {11.98, 3.1, 1.3}, 0.55));
  const int board =
      add_piece(scene, "wall board", box_shape({11.5, 5.2, 0.7}, {11.98, 7.0, 0.76}, 0.8), on_wall);
  add_piece(scene, "screen", box_shape({11.6, 5.6, 0.76}, {11.8, 6.4, 1.3}, 0.15), board);
  add_piece(scene, "wardrobe", box_shape({0.02, 5.6, 0}, {0.6, 7.6, 2.0}, 0.7));
  const int crate =
      add_piece(scene, "crate", rotated_box_shape({0.5, 2.2, 0}, {1.2, 2.9, 0.7}, 0.5, 0.45));
  add_piece(scene, "crate", rotated_box_shape({0.55, 2.3, 0.7}, {1.05, 2.8, 1.1}, 0.9, 0.5), crate);
  add_piece(scene, "chest", rotated_box_shape({10.6, 7.2, 0}, {11.3, 8.0, 0.9}, 0.35, 0.4));
  const int sideboard =
      add_piece(scene, "sideboard", box_shape({2.2, 8.4, 0}, {4.4, 8.98, 0.8}, 0.6));
  add_piece(scene, "screen", box_shape({2.6, 8.6, 0.8}, {3.9, 8.75, 1.55}, 0.12), sideboard);
  add_piece(scene, "cupboard", box_shape({5.6, 8.7, 0}, {6.6, 8.98, 2.1}, 0.3));

  const int table = add_piece(scene, "table", table_shape({4.9, 3.9, 0}, {7.1, 5.1, 0.75}, 0.6));
  add_piece(scene, "chair", chair_shape({5.4, 3.6, 0}, 1.4, 0.45));
  add_piece(scene, "chair", chair_shape({6.6, 3.55, 0}, 1.7, 0.45));
  add_piece(scene, "chair", chair_shape({5.5, 5.45, 0}, -1.5, 0.45));
  add_piece(scene, "chair", chair_shape({6.7, 5.4, 0}, -1.9, 0.45));
  add_piece(scene, "box", box_shape({5.7, 4.3, 0.75}, {6.0, 4.6, 1.0}, 0.85), table);
  // Pillars, a floor lamp and a beam under the ceiling.
  TriangleMesh& mesh = scene.surface;
  add_box(mesh, {3.0, 4.2, 0}, {3.4, 4.6, 3}, 0.7);
  add_cylinder(mesh, {8.8, 4.6, 0}, 0.22, 3, 0.65);
  TriangleMesh lamp = cylinder_shape({1.0, 8.2, 0}, 0.03, 1.6, 0.5);
  add_cylinder(lamp, {1.0, 8.2, 1.6}, 0.2, 0.3, 0.9);
  add_piece(scene, "lamp", lamp);
  add_box(mesh, {7.8, 0, 2.7}, {8.1, 9, 3}, 0.7);
}

/// Adds three waypoints on a line, so that the spline passes straight through the middle one.
void pass_through(std::vector<Waypoint>& waypoints, const Vector3d& middle,
                  const Vector3d& direction) {
  for (const double offset : {-0.6, 0.0, 0.6}) {
    waypoints.push_back({middle + offset * direction, direction});
  }
}

void add_flat_walls(TriangleMesh& mesh) {
  constexpr double height = 2.6;
  add_hull(mesh, {10, 8, height}, 0.5, 0.8, 0.75);
  // Inner walls along x = 5 and y = 4, with a door of 1.1 x 2.1 m between adjacent rooms.
  add_wall(mesh, {5, 0, 0}, {5, 4, 0}, height, 0.12, {{1.5, 2.6, 0, 2.1}}, 0.7);
  add_wall(mesh, {5, 4, 0}, {5, 8, 0}, height, 0.12, {{1.5, 2.6, 0, 2.1}}, 0.65);
  add_wall(mesh, {0, 4, 0}, {5, 4, 0}, height, 0.12, {{2.0, 3.1, 0, 2.1}}, 0.7);
  add_wall(mesh, {5, 4, 0}, {10, 4, 0}, height, 0.12, {{2.0, 3.1, 0, 2.1}}, 0.65);
}

void furnish_flat(Scene& scene) {
  const int on_wall = FurniturePiece::on_wall;
  // Living room, lower left.
  add_piece(scene, "sofa", sofa_shape({0.8, 0.05, 0}, {2.8, 0.9, 0.8}, 0.35));
  add_piece(scene, "low table", table_shape({0.9, 1.3, 0}, {1.7, 1.8, 0.45}, 0.6));
  add_piece(scene, "sideboard", box_shape({0.02, 2.4, 0}, {0.42, 3.8, 1.0}, 0.55));
  add_piece(scene, "shelf", shelf_shape({3.4, 0.02, 0}, {4.7, 0.37, 2.0}, true, 0.55));
  add_piece(scene, "plant", cylinder_shape({4.5, 3.5, 0}, 0.18, 1.5, 0.5));
  // Kitchen, lower right.
  add_piece(scene, "kitchen unit", box_shape({6.2, 0.02, 0}, {9.98, 0.62, 0.9}, 0.75));
  add_piece(scene, "wall cupboard", box_shape({7.4, 0.02, 1.45}, {9.98, 0.37, 2.2}, 0.7), on_wall);
  add_piece(scene, "fridge", box_shape({9.3, 0.62, 0}, {9.98, 1.3, 1.9}, 0.85));
  add_piece(scene, "table", table_shape({8.7, 2.3, 0}, {9.9, 3.2, 0.75}, 0.6));
  add_piece(scene, "chair", chair_shape({8.4, 2.7, 0}, 0.2, 0.45));
  add_piece(scene, "cupboard", box_shape({5.25, 3.3, 0}, {6.0, 3.85, 1.2}, 0.45));
  // Study, upper right.
  const int desk = add_piece(scene, "desk", table_shape({8.6, 7.2, 0}, {9.95, 7.95, 0.75}, 0.55));
  add_piece(scene, "screen", box_shape({9.0, 7.6, 0.75}, {9.6, 7.7, 1.2}, 0.12), desk);
  add_piece(scene, "shelf", shelf_shape({5.4, 7.6, 0}, {7.4, 7.97, 2.1}, false, 0.5));
  add_piece(scene, "cupboard", box_shape({9.4, 4.6, 0}, {9.98, 6.0, 1.8}, 0.7));
  add_piece(scene, "crate", rotated_box_shape({5.5, 4.4, 0}, {6.2, 5.0, 0.6}, 0.4, 0.4));
  // Bedroom, upper left.
  TriangleMesh bed = box_shape({0.05, 5.0, 0}, {1.5, 7.0, 0.5}, 0.8);
  add_box(bed, {0.02, 5.0, 0.5}, {0.1, 7.0, 1.1}, 0.4);
  add_piece(scene, "bed", bed);
  add_piece(scene, "wardrobe", box_shape({0.4, 7.4, 0}, {2.6, 7.97, 2.1}, 0.65));
  add_piece(scene, "chest of drawers", box_shape({3.9, 4.2, 0}, {4.8, 4.75, 0.9}, 0.5));
  add_piece(scene, "chest of drawers", box_shape({4.1, 7.3, 0}, {4.85, 7.95, 1.3}, 0.6));
}

}  // namespace

Scene room_scene() {
  Scene scene{.name = "room", .min_frames = 150, .max_range_m = 15.5};
  add_hull(scene.surface, {12, 9, 3}, 0.45, 0.8, 0.7);
  furnish_room(scene);
  // A closed loop around the middle of the room. The camera looks across it, at the opposite side.
  const Vector3d middle(6, 4.5, 1.4);
  std::vector<Waypoint> waypoints;
  constexpr int count = 14;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const double height = 0.12 * std::sin(2 * angle);
    const Vector3d place = middle + Vector3d(4.1 * std::cos(angle), 2.8 * std::sin(angle), height);
    const Vector3d ahead(-0.5 * std::sin(angle), 0.5 * std::cos(angle), 0.05 * std::cos(3 * angle));
    waypoints.push_back({place, (middle - place).normalized() + ahead - Vector3d(0, 0, 0.1)});
  }
  scene.path = CameraPath(std::move(waypoints), true);
  return scene;
}

Scene flat_scene() {
  Scene scene{.name = "flat", .min_frames = 300, .max_range_m = 13};
  add_flat_walls(scene.surface);
  furnish_flat(scene);
  constexpr double eye = 1.4;
  std::vector<Waypoint> waypoints;
  pass_through(waypoints, {5, 2.05, eye}, Vector3d::UnitX());
  waypoints.push_back({{7.0, 2.05, eye}, {1, 0.2, -0.05}});
  waypoints.push_back({{7.55, 2.5, eye}, {0.4, 1, -0.05}});
  pass_through(waypoints, {7.55, 4, eye}, Vector3d::UnitY());
  waypoints.push_back({{7.55, 5.6, eye}, {-0.2, 1, -0.05}});
  waypoints.push_back({{7.0, 6.05, eye}, {-1, 0.4, -0.05}});
  pass_through(waypoints, {5, 6.05, eye}, -Vector3d::UnitX());
  waypoints.push_back({{3.1, 6.05, eye}, {-1, -0.2, -0.05}});
  waypoints.push_back({{2.55, 5.5, eye}, {-0.4, -1, -0.05}});
  pass_through(waypoints, {2.55, 4, eye}, -Vector3d::UnitY());
  waypoints.push_back({{2.55, 2.5, eye}, {0.2, -1, -0.05}});
  waypoints.push_back({{3.1, 2.05, eye}, {1, -0.4, -0.05}});
  scene.path = CameraPath(std::move(waypoints), true);
  return scene;
}

/// A school hall with columns and benches. Most surfaces are within one wavelength of the camera;
/// the far end is not.
Scene hall_scene() {
  Scene scene{.name = "hall", .min_frames = 120, .max_range_m = 10.5};
  TriangleMesh& mesh = scene.surface;
  add_hull(mesh, {9, 5.5, 3.2}, 0.4, 0.8, 0.65);
  for (const double x : {2.2, 4.5, 6.8}) {
    add_cylinder(mesh, {x, 1.1, 0}, 0.18, 3.2, 0.7);
    add_box(mesh, {x - 0.15, 4.25, 0}, {x + 0.15, 4.55, 3.2}, 0.6);
    add_piece(scene, "bench", box_shape({x - 1.0, 5.05, 0}, {x + 0.4, 5.45, 0.45}, 0.35));
    add_box(mesh, {x - 0.2, 0, 2.8}, {x + 0.2, 5.5, 3.2}, 0.75);
  }
  add_piece(scene, "shelf", shelf_shape({0.6, 0.02, 0}, {2.0, 0.4, 1.9}, true, 0.5));
  add_piece(scene, "shelf", shelf_shape({7.2, 0.02, 0}, {8.6, 0.4, 1.9}, true, 0.3));
  add_piece(scene, "cupboard", box_shape({8.6, 2.0, 0}, {8.98, 3.4, 2.1}, 0.2));
  add_piece(scene, "table", table_shape({4.0, 2.2, 0}, {5.4, 3.0, 0.75}, 0.55));
  add_piece(scene, "coat stand", cylinder_shape({8.2, 4.8, 0}, 0.03, 1.9, 0.4));
  std::vector<Waypoint> waypoints;
  constexpr int count = 12;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const Vector3d place(4.6 + 2.9 * std::cos(angle), 2.7 + 0.75 * std::sin(angle), 1.5);
    waypoints.push_back(
        {place, {-std::sin(angle) - 0.6 * std::cos(angle), 0.8 * std::cos(angle), -0.1}});
  }
  scene.path = CameraPath(std::move(waypoints), true);
  return scene;
}

/// An atrium of 30 m with galleries around it. Most surfaces are several wavelengths away.
Scene atrium_scene() {
  Scene scene{.name = "atrium", .min_frames = 120, .max_range_m = 38};
  TriangleMesh& mesh = scene.surface;
  constexpr double length = 30;
  constexpr double width = 18;
  constexpr double height = 12;
  add_hull(mesh, {length, width, height}, 0.8, 0.95, 0.9);
  for (const double level : {3.6, 7.4}) {
    add_box(mesh, {0, 0, level}, {length, 2.6, level + 0.3}, 0.9);
    add_box(mesh, {0, width - 2.6, level}, {length, width, level + 0.3}, 0.9);
    add_box(mesh, {length - 3, 2.6, level}, {length, width - 2.6, level + 0.3}, 0.85);
    add_box(mesh, {0, 2.5, level + 0.3}, {length, 2.6, level + 1.3}, 0.95);
    add_box(mesh, {0, width - 2.6, level + 0.3}, {length, width - 2.5, level + 1.3}, 0.95);
  }
  for (double x = 4; x < length - 2; x += 5) {
    add_cylinder(mesh, {x, 2.4, 0}, 0.3, height, 0.9);
    add_box(mesh, {x - 0.25, width - 2.9, 0}, {x + 0.25, width - 2.4, height}, 0.85);
    add_piece(scene, "bench", box_shape({x - 0.6, 7.0, 0}, {x + 0.6, 8.2, 0.5}, 0.5));
    TriangleMesh plant = cylinder_shape({x + 1.5, 11.2, 0}, 0.45, 0.9, 0.3);
    add_cylinder(plant, {x + 1.5, 11.2, 0.9}, 0.12, 2.4, 0.35);
    add_piece(scene, "plant", plant);
  }
  add_piece(scene, "kiosk", box_shape({19, 8.2, 0}, {22, 10.6, 2.4}, 0.55));
  add_piece(scene, "counter", box_shape({12, 4.6, 0}, {13.2, 5.4, 1.1}, 0.85));
  // Stairs to the first gallery.
  for (int step = 0; step < 12; ++step) {
    const double x = 23 + 0.32 * step;
    add_box(mesh, {x, 3.2, 0}, {x + 0.32, 4.6, 0.3 * (step + 1)}, 0.6);
  }
  std::vector<Waypoint> waypoints;
  for (int i = 0; i <= 8; ++i) {
    const double sway = i % 2 == 0 ? 0.3 : -0.3;
    waypoints.push_back({{1.6 + 0.9 * i, 9.2 + sway, 1.6}, {1, 0.35 * std::sin(0.8 * i), 0.02}});
  }
  scene.path = CameraPath(std::move(waypoints), false);
  return scene;
}

}  // namespace tofmap
