// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/scenes.hpp>

// Frozen data
//
// No constant of the project is ever chosen on what this header names: not its scenes, not its
// seeds, not its pairs of frequencies, not its noises, not its errors. Whoever looks at figures of
// frozen data in order to change a method makes them development data: then they move to cases.cpp,
// and new ones are drawn here. Everything else that the benchmarks and tests use is development
// data, the scenes of docs/simulator.md and all seeds below 900 among it.

namespace tofmap::accuracy::frozen {

/// Seeds of `random`, of the noise and of the camera's errors from here on are frozen.
inline constexpr int first_seed = 900;

/// Image size: none of the development data has it.
inline constexpr int width_px = 224;
inline constexpr int height_px = 172;

/// Pairs of frequencies that are used for nothing else, and a noise for each.
struct Place {
  const char* scene;
  double frequency_a_hz;
  double frequency_b_hz;
  double range_noise_m;
};

/// Scenes of this folder, and rooms drawn by frozen seeds.
inline constexpr Place places[] = {
    {"attic", 20e6, 21.5e6, 0.013}, {"attic", 24e6, 27e6, 0.08},    {"depot", 24e6, 27e6, 0.037},
    {"depot", 20e6, 21.5e6, 0.013}, {"workshop", 60e6, 75e6, 0.08}, {"workshop", 48e6, 53e6, 0.037},
    {"random", 48e6, 53e6, 0.013},  {"random", 24e6, 27e6, 0.037},
};

/// The scenes of the frozen grid, with a pair of frequencies each; the grid has noises of its own.
inline constexpr Place grid_places[] = {
    {"attic", 20e6, 21.5e6, 0},
    {"depot", 24e6, 27e6, 0},
    {"workshop", 60e6, 75e6, 0},
    {"random", 48e6, 53e6, 0},
};

/// Draws the random combinations of the frozen grid.
inline constexpr int combinations_seed = 977;

/// `attic` (14 x 8 m under a gable roof: nearly every surface is slanted), `depot` (30 x 18 x 6.5
/// m, dark, with racks of thin boards full of boxes), `workshop` (7.5 x 5.5 x 3 m, machines and
/// round tanks close to the camera), or a built-in scene.
Scene make_scene(const std::string& name, int seed);

}  // namespace tofmap::accuracy::frozen
