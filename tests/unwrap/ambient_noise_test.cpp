// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ambient_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/unwrap/phase_noise.hpp>

namespace tofmap {
namespace {

/// c of the simulated camera: the noise of a phase is c / amplitude cycles.
double true_scale(const Simulator& simulator) {
  return simulator.noise_sigma() / (2 * std::numbers::pi);
}

/// The median over some pixels of what noise is said to be, over the true one without ambient
/// light.
double median_factor(const ImageF& ambient, double scale, double true_scale, Eigen::Index row,
                     Eigen::Index col, Eigen::Index rows, Eigen::Index cols) {
  std::vector<double> factors;
  for (Eigen::Index v = row; v < row + rows; ++v) {
    for (Eigen::Index u = col; u < col + cols; ++u) {
      factors.push_back(scale / true_scale * (ambient.size() > 0 ? double{ambient(v, u)} : 1));
    }
  }
  return median(factors);
}

TEST(AmbientNoise, OfARectangleOfFiveTimesTheNoiseIsFound) {
  SimulatorOptions simulation;
  simulation.ambient_noise = 5;
  for (const char* scene : {"flat", "hall", "room"}) {
    const Simulator simulator(make_scene(scene), simulation);
    const DualFrequencyFrame frame = simulator.simulate(20).frame;
    const PhaseNoise noise = estimate_phase_noise(frame);
    const ImageF ambient = find_ambient_noise(frame, noise);
    ASSERT_EQ(ambient.rows(), 144) << scene;
    ASSERT_EQ(ambient.cols(), 176) << scene;
    // Light falls on the right upper quarter. A block of 16 pixels on both sides of its border is
    // left to interpolation.
    std::printf("%s: c %.3f inside %.3f outside left %.3f below %.3f\n", scene, noise.scale_a/true_scale(simulator), 
        median_factor(ambient, noise.scale_a, true_scale(simulator), 0, 104, 56, 72),
        median_factor(ambient, noise.scale_a, true_scale(simulator), 0, 0, 144, 72),
        median_factor(ambient, noise.scale_a, true_scale(simulator), 88, 0, 56, 176));
  }
}

TEST(AmbientNoise, IsNotFoundOnCleanScenesWithEdges) {
  for (const char* scene : {"flat", "hall", "room", "corridor", "atrium"}) {
    const Simulator simulator(make_scene(scene), {});
    int n = 0, found = 0; float most = 0; double px=0;
    for (int i = 3; i < *simulator.frame_count(); i += 9) {
      const DualFrequencyFrame frame = simulator.simulate(i).frame;
      const ImageF a = find_ambient_noise(frame, estimate_phase_noise(frame));
      ++n; found += a.size() > 0; if (a.size()) { most = std::max(most, a.maxCoeff()); px += (a > 1.4F).count() / double(a.size());}
    }
    std::printf("%s: %d of %d, most %.2f, px %.4f\n", scene, found, n, most, px/n);
  }
}

TEST(AmbientNoise, OfNoImageIsNone) {
  const DualFrequencyFrame nothing;
  EXPECT_EQ(find_ambient_noise(nothing, {.scale_a = 0.1, .scale_b = 0.1}).size(), 0);
}

TEST(AmbientNoise, IsNotFoundWithoutReturns) {
  DualFrequencyFrame dark;
  dark.phase_a = dark.phase_b = ImageF::Constant(40, 50, NAN);
  dark.amplitude_a = dark.amplitude_b = ImageF::Zero(40, 50);
  EXPECT_EQ(find_ambient_noise(dark, {.scale_a = 0.1, .scale_b = 0.1}).size(), 0);
}

}  // namespace
}  // namespace tofmap
