// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "samples.hpp"

#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::bench {

/// From where a scene is seen.
enum class Views {
  path,        ///< the scene's own path
  near_walls,  ///< 0.3 to 1 m in front of what surrounds that path, at any angle to it
};

/// Simulated frames of one scene or of several random rooms.
struct Recording {
  std::string name;
  std::string scene;  ///< a built-in scene or a mesh file
  int first_seed = 1;
  int seeds = 1;   ///< scenes of successive seeds
  int frames = 8;  ///< of each scene
  Views views = Views::path;
  double range_noise_m = 0.02;
  int width_px = 176;
  int subpixels = 3;
  double wiggle_m = 0;
  double b_offset_m = 0;  ///< added to all ranges of B
};

/// Recordings on which the constants of filters may be chosen.
std::vector<Recording> development_recordings();

/// Recordings on which no constant of a filter may ever be chosen, nor anything else be tuned: they
/// tell what filters do on recordings of others. Meshes of others may be added to them.
std::vector<Recording> frozen_recordings();

/// Simulates and unwraps by `joint`. `divisor` divides the number of scenes and frames.
Case make_case(const Recording& recording, int divisor);

}  // namespace tofmap::bench
