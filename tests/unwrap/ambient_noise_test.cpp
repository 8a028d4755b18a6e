// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/ambient_noise.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/median.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/errors/phase_noise.hpp>

namespace tofmap {
namespace {

/// c of the simulated camera: the noise of a phase is c / amplitude cycles.
double true_scale(const Simulator& simulator) {
  return simulator.noise_sigma() / (2 * std::numbers::pi);
}

/// The median over some pixels of what is said of the noise, over the true one without ambient
/// light.
double median_factor(const ImageF& ambient, double scale_factor, Eigen::Index row, Eigen::Index col,
                     Eigen::Index rows, Eigen::Index cols) {
  std::vector<double> factors;
  for (Eigen::Index v = row; v < row + rows; ++v) {
    for (Eigen::Index u = col; u < col + cols; ++u) {
      factors.push_back(scale_factor * ambient(v, u));
    }
  }
  return median(factors);
}

TEST(AmbientNoise, OfARectangleOfFiveTimesTheNoiseIsFound) {
  SimulatorOptions simulation;
  simulation.ambient_noise = 5;
  for (const char* scene : {"flat", "hall", "room"}) {
    const Simulator simulator(make_scene(scene), simulation);
    const Frame frame = simulator.simulate(20).frame;
    const std::vector<PhaseNoise> noise = estimate_phase_noise(frame);
    const ImageF ambient = find_ambient_noise(frame, noise);
    ASSERT_EQ(ambient.rows(), 144) << scene;
    ASSERT_EQ(ambient.cols(), 176) << scene;
    const auto factor = [&](Eigen::Index row, Eigen::Index col, Eigen::Index rows,
                            Eigen::Index cols) {
      return median_factor(ambient, noise[0].scale / true_scale(simulator), row, col, rows, cols);
    };
    // Light falls on the right upper quarter. A block of 16 pixels on both sides of its border is
    // left to interpolation.
    EXPECT_NEAR(factor(0, 104, 56, 72), 5, 0.2 * 5) << scene;
    // c is the median of the whole image, a quarter of which is noisy: too much by a third.
    EXPECT_NEAR(factor(0, 0, 144, 72), 1.2, 0.25) << scene;
    EXPECT_NEAR(factor(88, 0, 56, 176), 1.2, 0.25) << scene;
  }
}

TEST(AmbientNoise, IsNotFoundOnCleanScenesWithEdges) {
  for (const char* scene : {"flat", "hall", "room", "corridor"}) {
    const Simulator simulator(make_scene(scene), {});
    const int total = *simulator.frame_count();
    for (int i = 3; i < total; i += total / 6) {
      const Frame frame = simulator.simulate(i).frame;
      const ImageF ambient = find_ambient_noise(frame, estimate_phase_noise(frame));
      if (ambient.size() == 0) continue;
      // Chance may take one block of 16 x 16 pixels past its threshold, 1 % of an image.
      EXPECT_LE((ambient > 1.2F).count(), 256) << scene << ", frame " << i;
      EXPECT_LT(ambient.maxCoeff(), 1.7F) << scene << ", frame " << i;
    }
  }
}

TEST(AmbientNoise, IsNotFoundWhereDifferencesWrap) {
  // Without amplitudes, so that all pixels are predicted to be equally noisy.
  for (const double sigma_cycles : {0.1, 0.15, 0.2, 0.25, 0.3}) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0.5, sigma_cycles);
    Frame frame;
    for (int f = 0; f < 2; ++f) {
      ImageF phase(144, 176);
      for (float& cycles : phase.reshaped()) {
        const double drawn = normal(random);
        cycles = static_cast<float>(drawn - std::floor(drawn));
      }
      frame.phases.push_back(phase);
    }
    EXPECT_EQ(find_ambient_noise(frame, estimate_phase_noise(frame)).size(), 0) << sigma_cycles;
  }
}

TEST(AmbientNoise, OfNoImageIsNone) {
  const Frame nothing;
  EXPECT_EQ(find_ambient_noise(nothing, {{.scale = 0.1}, {.scale = 0.1}}).size(), 0);
}

TEST(AmbientNoise, IsNotFoundWithoutReturns) {
  Frame dark = blank_frame(2);
  dark.phases[0] = dark.phases[1] = ImageF::Constant(40, 50, NAN);
  dark.amplitudes[0] = dark.amplitudes[1] = ImageF::Zero(40, 50);
  EXPECT_EQ(find_ambient_noise(dark, {{.scale = 0.1}, {.scale = 0.1}}).size(), 0);
}

}  // namespace
}  // namespace tofmap
