// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/unwrap/phase_noise.hpp>

namespace tofmap {
namespace {

TEST(PhaseNoise, IsFoundOnAWrappedSlopeOfVaryingAmplitude) {
  constexpr double scale = 2.0;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  DualFrequencyFrame frame;
  frame.phase_a.resize(96, 128);
  frame.amplitude_a.resize(96, 128);
  for (Eigen::Index v = 0; v < 96; ++v) {
    for (Eigen::Index u = 0; u < 128; ++u) {
      const double amplitude = 50 + 3.0 * static_cast<double>(u);
      const double cycles = 0.021 * static_cast<double>(u) + 0.013 * static_cast<double>(v) +
                            scale / amplitude * normal(random);
      frame.amplitude_a(v, u) = static_cast<float>(amplitude);
      frame.phase_a(v, u) = static_cast<float>(cycles - std::floor(cycles));
    }
  }
  frame.phase_b = frame.phase_a;
  frame.amplitude_b = frame.amplitude_a;
  // The median of 24 000 second differences scatters by about one percent.
  EXPECT_NEAR(estimate_phase_noise(frame).scale_a, scale, 0.05 * scale);
}

}  // namespace
}  // namespace tofmap
