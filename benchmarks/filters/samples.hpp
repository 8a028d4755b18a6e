// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::bench {

/// A simulated frame, unwrapped.
struct Sample {
  SimulatedFrame simulated;
  RangeImage unwrapped;
};

/// Frames of one kind, all by the same camera.
struct Case {
  std::string name;
  SensorModel sensor;
  PixelRays rays;
  std::vector<Sample> samples;
};

/// Random rooms and built-in scenes, unwrapped by a method; `divisor` divides the number of frames.
std::vector<Case> make_cases(const std::string& method, int divisor);

/// Frames next to one another on a scene's path.
Case make_run(const std::string& scene, int frames);

/// Whether several surfaces were in the pixel's view.
bool sees_several_surfaces(const Sample& sample, Eigen::Index row, Eigen::Index col);

/// Whether A's range, before wraps, is none of those surfaces (PixelLabel::flying).
bool is_labelled_flying(const Sample& sample, Eigen::Index row, Eigen::Index col);

/// A pixel that sees several surfaces flies if its range is none of the surfaces around it, by more
/// than 5 cm and three standard deviations of its noise. (The label itself is of A's range alone.)
bool is_flying(const Sample& sample, Eigen::Index row, Eigen::Index col);

}  // namespace tofmap::bench
