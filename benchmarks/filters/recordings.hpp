// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "samples.hpp"

#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::bench {

/// The viewpoints that a scene is seen from.
enum class Views {
  path,        ///< the scene's own path
  near_walls,  ///< 0.3 to 1 m in front of surfaces around that path, at angles up to 90°
};

/// Simulated frames of one scene or of several random rooms.
struct Recording {
  std::string name;
  std::string scene;  ///< name of a built-in scene, or a mesh file
  int first_seed = 1;
  int seeds = 1;   ///< number of successive seeds, each with its own scene
  int frames = 8;  ///< frames per scene
  Views views = Views::path;
  double range_noise_m = 0.02;
  int width_px = 176;
  int subpixels = 3;
  double wiggle_m = 0;
  double b_offset_m = 0;  ///< offset that is added to all ranges of B
};

/// Development data: recordings that constants of filters may be chosen on.
std::vector<Recording> development_recordings();

/// Frozen data: recordings that no constant may be chosen on and nothing may be tuned on. They show
/// how filters perform on unknown recordings.
std::vector<Recording> frozen_recordings();

/// Simulates a recording and unwraps it with `joint`. `divisor` divides the number of scenes and
/// frames.
Case make_case(const Recording& recording, int divisor);

}  // namespace tofmap::bench
