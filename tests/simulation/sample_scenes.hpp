// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <tofmap/core/image.hpp>
#include <tofmap/simulation/scenes.hpp>
#include <tofmap/simulation/simulator.hpp>

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

/// A wall at 4 m behind one at 2 m, whose edge runs down the middle of the image. The camera is
/// turned by `turned_rad`, so that the edge passes through pixels.
inline Scene edge_scene(double turned_rad) {
  Scene scene = facing_wall_scene(4, 0.8);
  add_facing_wall(scene.surface, 2, 0.2, 0.0);
  const Eigen::Vector3d ahead(std::cos(turned_rad), std::sin(turned_rad), 0);
  scene.path = CameraPath({{{0, 0.0, 0}, ahead}, {{0, 0.0, 0}, ahead}}, false);
  return scene;
}

/// A small camera without noise, mixed pixels, or motion between A and B.
inline SimulatorOptions ideal_camera() {
  SimulatorOptions options;
  options.width_px = 40;
  options.height_px = 24;
  options.subpixels = 1;
  options.range_noise_m = 0;
  options.b_delay_share = 0;
  return options;
}

/// Errors of the ranges that phases stand for, measured minus true, with the wrap counts that make
/// them smallest.
inline ImageF range_error_m(const ImageF& phase, const ImageF& range_truth_m, double wavelength_m) {
  return range_truth_m.binaryExpr(phase, [wavelength_m](float truth_m, float cycles) {
    const double off = double{cycles} - double{truth_m} / wavelength_m;
    return static_cast<float>(wavelength_m * (off - std::round(off)));
  });
}

}  // namespace tofmap::test
