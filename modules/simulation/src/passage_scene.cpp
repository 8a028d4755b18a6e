// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Bright walls at 0.3 m in front of dark walls at 15 m in the same view: amplitudes over four
// decades.

#include "builtin_scenes.hpp"
#include "furniture_shapes.hpp"

#include <array>

namespace tofmap {

using Eigen::Vector3d;

namespace {

constexpr double partition_height = 2.1;
constexpr double partition_thickness = 0.8;
constexpr double block_width = 1;

/// An opening in a partition that stands across the path. The camera passes close to one jamb and
/// turns towards it.
struct Opening {
  double x;           ///< centre of the partition along the path, metres
  double y;           ///< of the camera in the opening, metres
  double side;        ///< of the near jamb: 1 left, −1 right
  double far_jamb_m;  ///< from the camera to the other jamb, across the path
};

/// From the camera to the near jamb, across the path.
constexpr double near_jamb_m = 0.32;

/// The openings are offset sideways, so that the camera sees the hall past a jamb, not the next
/// partition.
constexpr std::array<Opening, 3> openings{
    {{2.2, 8.0, 1, 0.75}, {4.8, 6.8, -1, 0.6}, {7.4, 8.0, 1, 0.5}}};

/// Adds a block on each side of the path.
void add_partition(TriangleMesh& mesh, const Opening& opening, double reflectance) {
  const double left = opening.y + (opening.side > 0 ? near_jamb_m : opening.far_jamb_m);
  const double right = opening.y - (opening.side > 0 ? opening.far_jamb_m : near_jamb_m);
  const double from_x = opening.x - partition_thickness / 2;
  const double to_x = opening.x + partition_thickness / 2;
  add_box(mesh, {from_x, left, 0}, {to_x, left + block_width, partition_height}, reflectance);
  add_box(mesh, {from_x, right - block_width, 0}, {to_x, right, partition_height}, reflectance);
}

/// Adds dark objects at all ranges between the partitions and the far wall.
void furnish_hall(Scene& scene, double height) {
  TriangleMesh& mesh = scene.surface;
  for (const double x : {10.0, 14.0, 18.0}) {
    add_cylinder(mesh, {x, 4.2, 0}, 0.3, height, 0.12);
    add_cylinder(mesh, {x, 11.8, 0}, 0.3, height, 0.12);
  }
  add_piece(scene, "crate", box_shape({11.2, 7.0, 0}, {12.4, 7.9, 0.8}, 0.25));
  add_piece(scene, "crate", box_shape({15.0, 9.0, 0}, {16.2, 10.0, 1.7}, 0.1));
  add_piece(scene, "cupboard", box_shape({19.0, 5.4, 0}, {19.6, 7.0, 2.2}, 0.15));
  add_piece(scene, "crate", rotated_box_shape({12.5, 12.6, 0}, {14.0, 13.4, 1.2}, 0.5, 0.3));
  add_piece(scene, "crate", rotated_box_shape({9.0, 2.0, 0}, {10.2, 3.0, 1.5}, 0.8, 0.2));
  add_piece(scene, "board", box_shape({21.9, 8.4, 1.0}, {22.0, 10.4, 2.4}, 0.3),
            FurniturePiece::on_wall);
  add_box(mesh, {8.0, 0, height - 0.5}, {8.4, 16, height}, 0.1);
  add_box(mesh, {13.0, 0, height - 0.5}, {13.4, 16, height}, 0.1);
}

/// Adds seven waypoints on a line through the opening, so that the spline is straight between the
/// jambs. The viewing direction turns from straight ahead towards the near jamb and back.
void go_through(std::vector<Waypoint>& waypoints, const Opening& opening) {
  constexpr double spacing_m = 0.3;
  constexpr double eye_m = 1.4;
  constexpr std::array<double, 7> sideways{0.1, 0.4, 0.75, 0.85, 0.7, 0.4, 0.1};
  for (int i = 0; i < 7; ++i) {
    const double x = opening.x + (i - 3) * spacing_m;
    const double y = opening.side * sideways[static_cast<std::size_t>(i)];
    waypoints.push_back({{x, opening.y, eye_m}, {1, y, -0.03}});
  }
}

}  // namespace

Scene passage_scene() {
  Scene scene{.name = "passage", .min_frames = 120, .max_range_m = 24};
  constexpr double height = 4.5;
  add_hull(scene.surface, {22, 16, height}, 0.12, 0.1, 0.08);
  for (const Opening& opening : openings) add_partition(scene.surface, opening, 0.9);
  furnish_hall(scene, height);
  std::vector<Waypoint> waypoints{{{0.8, 8, 1.4}, {1, 0, 0}}};
  for (const Opening& opening : openings) go_through(waypoints, opening);
  waypoints.push_back({{8.6, 8, 1.4}, {1, 0, 0}});
  scene.path = CameraPath(std::move(waypoints), false);
  return scene;
}

}  // namespace tofmap
