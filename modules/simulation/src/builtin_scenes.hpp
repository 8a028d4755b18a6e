// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/scenes.hpp>

namespace tofmap {

// One function for each built-in scene (docs/simulator.md).
Scene wall_scene();
Scene slope_scene();
Scene beyond_scene();
Scene corridor_scene();
Scene room_scene();
Scene flat_scene();
Scene hall_scene();
Scene atrium_scene();
Scene passage_scene();
Scene random_scene(int seed);

/// Adds floor, ceiling and four walls of a room of `size_m` whose lowest corner is at the origin.
/// `floor`, `ceiling` and `walls` are reflectances; those of the four walls differ a little.
void add_hull(TriangleMesh& mesh, const Eigen::Vector3d& size_m, double floor, double ceiling,
              double walls);

}  // namespace tofmap
