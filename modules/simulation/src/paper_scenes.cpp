// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes that isolate one property each. The first two are the experiments of Droeschel, Holz and
// Behnke (IROS 2010). λ_A is 5.17 m at 29 MHz.

#include "builtin_scenes.hpp"
#include "furniture_shapes.hpp"

namespace tofmap {

using Eigen::Vector3d;

void add_hull(TriangleMesh& mesh, const Vector3d& size_m, double floor, double ceiling,
              double walls) {
  const Vector3d x(size_m.x(), 0, 0);
  const Vector3d y(0, size_m.y(), 0);
  const Vector3d z(0, 0, size_m.z());
  const Vector3d origin = Vector3d::Zero();
  add_quad(mesh, origin, x, y, floor);
  add_quad(mesh, z, x, y, ceiling);
  add_quad(mesh, origin, x, z, walls);
  add_quad(mesh, y, x, z, 0.9 * walls);
  add_quad(mesh, origin, y, z, 0.95 * walls);
  add_quad(mesh, x, y, z, 1.05 * walls);
}

/// First experiment: walls and floor extend without a step from less than one wavelength to 8 m, so
/// that differences between neighbouring pixels suffice to find the wrap counts.
Scene wall_scene() {
  Scene scene{.name = "wall", .min_frames = 20, .max_range_m = 10.3};
  add_hull(scene.surface, {9, 5, 3}, 0.6, 0.7, 0.7);
  scene.path = CameraPath({{{0.9, 2.2, 1.5}, {1, 0.05, 0}},
                           {{1.1, 2.5, 1.5}, {1, 0, 0}},
                           {{1.2, 2.8, 1.5}, {1, -0.05, 0}},
                           {{1.3, 3.0, 1.5}, {1, -0.08, 0}}},
                          false);
  return scene;
}

/// Second experiment: all far surfaces are seen through two openings in a near wall, behind steps
/// of more than λ_A / 2. One of them is a steeply slanted wall, the other faces the camera. No
/// surface connects them with the near wall, so that phase differences alone give wrong wrap
/// counts.
Scene slope_scene() {
  Scene scene{.name = "slope", .min_frames = 20, .max_range_m = 10.3};
  constexpr double near_x = 2.6;
  // The wall fills the view from every place on the path, so that nothing is seen beside it.
  add_wall(scene.surface, {near_x, -3, 0}, {near_x, 3, 0}, 4, 0.02,
           {{1.5, 2.75, 0.95, 2.05}, {3.3, 4.5, 0.95, 2.05}}, 0.6);
  // The slanted wall, behind the opening that is on the right in the image: its range grows from
  // 5.4 m to 9.7 m over the width of the opening. It bends before its range exceeds two
  // wavelengths, and a board closes the gap at its near end.
  const Vector3d bend(8.6, -4.53, -1);
  add_quad(scene.surface, {5.3, -0.8, -1}, bend - Vector3d(5.3, -0.8, -1), {0, 0, 6}, 0.8);
  add_quad(scene.surface, bend, {0, -2, 0}, {0, 0, 6}, 0.8);
  add_quad(scene.surface, {5.3, -0.8, -1}, {0.6, 0.2, 0}, {0, 0, 6}, 0.8);
  // The wall that faces the camera, behind the left opening, at 5.9 m.
  add_quad(scene.surface, {5.9, -0.6, -1}, {0, 6, 0}, {0, 0, 6}, 0.7);
  scene.path = CameraPath({{{-0.05, 0.0, 1.5}, {1, 0, 0}},
                           {{0.0, 0.04, 1.5}, {1, 0.01, 0}},
                           {{0.05, 0.0, 1.5}, {1, -0.01, 0}},
                           {{0.1, -0.04, 1.5}, {1, 0, 0}}},
                          false);
  return scene;
}

/// A hall seen from a gallery. No visible surface is nearer than one wavelength.
Scene beyond_scene() {
  Scene scene{.name = "beyond", .min_frames = 20, .max_range_m = 15.5};
  add_hull(scene.surface, {12, 13, 9}, 0.7, 0.8, 0.8);
  add_piece(scene, "crate", box_shape({6.5, 2, 0}, {8.5, 3.5, 1.2}, 0.8));
  add_piece(scene, "cupboard", box_shape({8, 8.5, 0}, {9.2, 10.5, 2}, 0.6));
  add_piece(scene, "crate", box_shape({5, 6, 0}, {6, 7.5, 0.8}, 0.9));
  add_cylinder(scene.surface, {9.5, 6, 0}, 0.4, 4, 0.7);
  scene.path = CameraPath({{{1.5, 6.2, 7}, {1, 0.02, -0.65}},
                           {{1.5, 6.4, 7}, {1, 0, -0.65}},
                           {{1.5, 6.6, 7}, {1, -0.02, -0.65}},
                           {{1.5, 6.8, 7}, {1, -0.04, -0.65}}},
                          false);
  return scene;
}

/// A corridor of 20 m, nearly four wavelengths, with doors in niches, pillars and boxes.
Scene corridor_scene() {
  Scene scene{.name = "corridor", .min_frames = 150, .max_range_m = 20.4};
  TriangleMesh& mesh = scene.surface;
  constexpr double length = 20;
  constexpr double width = 2.4;
  constexpr double height = 2.7;
  add_quad(mesh, {0, -0.4, 0}, {length, 0, 0}, {0, width + 0.8, 0}, 0.5);
  add_quad(mesh, {0, -0.4, height}, {length, 0, 0}, {0, width + 0.8, 0}, 0.8);
  add_quad(mesh, {0, -0.4, 0}, {0, width + 0.8, 0}, {0, 0, height}, 0.7);
  add_quad(mesh, {length, -0.4, 0}, {0, width + 0.8, 0}, {0, 0, height}, 0.8);
  // Door niches are 0.3 m deep: openings in walls of that thickness, with a door leaf behind.
  const std::vector<WallOpening> left{
      {2, 2.95, 0, 2.1}, {7, 7.95, 0, 2.1}, {12.5, 13.45, 0, 2.1}, {17, 17.95, 0, 2.1}};
  const std::vector<WallOpening> right{
      {4.5, 5.45, 0, 2.1}, {10, 11.6, 0, 2.3}, {15.2, 16.15, 0, 2.1}};
  add_wall(mesh, {0, width, 0}, {length, width, 0}, height, 0.3, left, 0.75);
  add_wall(mesh, {length, 0, 0}, {0, 0, 0}, height, 0.3,
           {{length - 16.15, length - 15.2, 0, 2.1},
            {length - 11.6, length - 10, 0, 2.3},
            {length - 5.45, length - 4.5, 0, 2.1}},
           0.7);
  for (const WallOpening& door : left) {
    add_quad(mesh, {door.from_m - 0.1, width + 0.3, 0}, {door.to_m - door.from_m + 0.2, 0, 0},
             {0, 0, 2.4}, 0.45);
  }
  for (const WallOpening& door : right) {
    add_quad(mesh, {door.from_m - 0.1, -0.3, 0}, {door.to_m - door.from_m + 0.2, 0, 0}, {0, 0, 2.5},
             0.55);
  }
  for (const double x : {3.6, 9.0, 14.4}) {
    add_box(mesh, {x, 0, 0}, {x + 0.35, 0.3, height}, 0.6);
    add_box(mesh, {x + 0.9, width - 0.25, 0}, {x + 1.2, width, height}, 0.65);
  }
  add_piece(scene, "box", box_shape({6.2, 0, 0}, {6.7, 0.4, 1.1}, 0.3));
  add_piece(scene, "box", box_shape({16.4, width - 0.45, 0}, {16.9, width, 0.9}, 0.35));
  add_piece(scene, "box", box_shape({11.9, width - 0.4, 0}, {12.3, width, 1.4}, 0.5));
  std::vector<Waypoint> waypoints;
  for (int i = 0; i <= 8; ++i) {
    const double sway = i % 2 == 0 ? 0.12 : -0.12;
    waypoints.push_back({{1.0 + 1.2 * i, 1.2 + sway, 1.4}, {1, -0.4 * sway, -0.03}});
  }
  scene.path = CameraPath(std::move(waypoints), false);
  return scene;
}

}  // namespace tofmap
