// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::bench {

/// A simulated frame and its unwrapped ranges.
struct Sample {
  SimulatedFrame simulated;
  RangeImage unwrapped;
};

/// Frames of one kind, all from the same camera.
struct Case {
  std::string name;
  SensorModel sensor;
  PixelRays rays;
  std::vector<Sample> samples;
};

/// Frames of random rooms and built-in scenes, unwrapped by a method. `divisor` divides the number
/// of frames.
std::vector<Case> make_cases(const std::string& method, int divisor);

/// Successive frames from the middle of the path of a scene, unwrapped by `joint`.
Case make_run(const std::string& scene, int frames);

/// Whether the pixel sees several surfaces, that is, whether it is labelled as mixed or flying.
bool sees_several_surfaces(const Sample& sample, Eigen::Index row, Eigen::Index col);

/// Whether the pixel is labelled as flying (PixelLabel::flying). The label depends only on the
/// range of frequency A.
bool is_labelled_flying(const Sample& sample, Eigen::Index row, Eigen::Index col);

/// Whether the pixel is flying: it sees several surfaces, and its unwrapped range differs from the
/// true range of each of the 3 x 3 pixels around it by more than 5 cm and more than three standard
/// deviations of its noise.
bool is_flying(const Sample& sample, Eigen::Index row, Eigen::Index col);

}  // namespace tofmap::bench
