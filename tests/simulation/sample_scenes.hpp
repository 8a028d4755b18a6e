// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/scenes.hpp>

namespace tofmap::test {

/// A wall across the view, `range_m` in front of a camera at the origin that looks along +x. It
/// covers y ≥ `from_y_m`.
inline void add_facing_wall(TriangleMesh& mesh, double range_m, double reflectance,
                            double from_y_m = -60) {
  add_quad(mesh, {range_m, from_y_m, -60}, {0, 60 - from_y_m, 0}, {0, 0, 120}, reflectance);
}

/// One wall, and a camera that walks `walk_m` towards it from the origin.
inline Scene facing_wall_scene(double range_m, double reflectance, double walk_m = 0) {
  Scene scene;
  scene.name = "facing wall";
  add_facing_wall(scene.surface, range_m, reflectance);
  const Eigen::Vector3d ahead(1, 0, 0);
  scene.path = CameraPath({{{0, 0, 0}, ahead}, {{walk_m, 0, 0}, ahead}}, false);
  scene.min_frames = 2;
  scene.max_range_m = 60;
  return scene;
}

}  // namespace tofmap::test
