// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/scenes.hpp>

// Frozen data
//
// No constant of the project may be chosen on the scenes, seeds, frequency pairs, noises and errors
// in this header. Data become development data as soon as somebody changes a method because of
// their figures: then they must move to cases.cpp, and new ones must be drawn here. All other data
// of benchmarks and tests are development data, including the scenes of docs/simulator.md and all
// seeds below 900.

namespace tofmap::accuracy::frozen {

/// Seeds of random rooms, of noise and of camera errors are frozen from this one on.
inline constexpr int first_seed = 900;

/// The image size, which no development data have.
inline constexpr int width_px = 224;
inline constexpr int height_px = 172;

/// A scene with a frequency pair that no development data have, and a noise.
struct Place {
  const char* scene;
  double frequency_a_hz;
  double frequency_b_hz;
  double range_noise_m;
};

/// Scenes of make_scene() and random rooms of frozen seeds.
inline constexpr Place places[] = {
    {"attic", 20e6, 21.5e6, 0.013}, {"attic", 24e6, 27e6, 0.08},    {"depot", 24e6, 27e6, 0.037},
    {"depot", 20e6, 21.5e6, 0.013}, {"workshop", 60e6, 75e6, 0.08}, {"workshop", 48e6, 53e6, 0.037},
    {"random", 48e6, 53e6, 0.013},  {"random", 24e6, 27e6, 0.037},
};

/// The scenes of the frozen grid with their frequency pairs. The grid has its own noises.
inline constexpr Place grid_places[] = {
    {"attic", 20e6, 21.5e6, 0},
    {"depot", 24e6, 27e6, 0},
    {"workshop", 60e6, 75e6, 0},
    {"random", 48e6, 53e6, 0},
};

/// The seed of the random error combinations of the frozen grid.
inline constexpr int combinations_seed = 977;

/// `attic` (14 x 8 m under a gable roof: nearly every surface is slanted), `depot` (30 x 18 x 6.5
/// m, dark, with racks of thin boards full of boxes), `workshop` (7.5 x 5.5 x 3 m, machines and
/// round tanks close to the camera), or a built-in scene.
Scene make_scene(const std::string& name, int seed);

}  // namespace tofmap::accuracy::frozen
