// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/unwrap/errors/phase_noise.hpp>

namespace tofmap {
namespace {

/// Noise of σ = scale / amplitude on a wrapped slope with a step, under varying amplitudes.
Frame noisy_slope(double scale) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  Frame frame = blank_frame(2);
  frame.phases[0].resize(96, 128);
  frame.amplitudes[0].resize(96, 128);
  for (Eigen::Index v = 0; v < 96; ++v) {
    for (Eigen::Index u = 0; u < 128; ++u) {
      const double amplitude = 50 + 3.0 * static_cast<double>(u % 40);
      const double cycles = 0.011 * static_cast<double>(u) + 0.007 * static_cast<double>(v) +
                            (u > 60 ? 0.4 : 0) + scale / amplitude * normal(random);
      frame.amplitudes[0](v, u) = static_cast<float>(amplitude);
      frame.phases[0](v, u) = static_cast<float>(cycles - std::floor(cycles));
    }
  }
  frame.phases[1] = frame.phases[0];
  frame.amplitudes[1] = frame.amplitudes[0];
  return frame;
}

class PhaseNoiseOf : public testing::TestWithParam<double> {};
// At an amplitude of 100 from a thousandth of a cycle to 1.6 radians, where most differences wrap.
INSTANTIATE_TEST_SUITE_P(Scales, PhaseNoiseOf,
                         testing::Values(0.1, 2.0, 5.0, 8.0, 12.0, 16.0, 20.0, 25.0));

TEST_P(PhaseNoiseOf, IsFoundOnAWrappedSlopeOfVaryingAmplitude) {
  // The median of 16 000 second differences scatters by about one percent; slopes and steps
  // add a little.
  EXPECT_NEAR(estimate_phase_noise(noisy_slope(GetParam()))[0].scale, GetParam(),
              0.05 * GetParam());
}

TEST(PhaseNoise, IsNoLessThanTheQuantisationOfPhases) {
  Frame frame = blank_frame(2);
  frame.phases[0] = frame.phases[1] = ImageF::Constant(20, 20, 0.5F);
  EXPECT_GT(estimate_phase_noise(frame)[0].scale, 0.1 / 65535);
}

/// The phases of a noisy slope, rounded to so many levels a cycle.
Frame rounded_slope(double scale, float levels_a, float levels_b) {
  Frame frame = noisy_slope(scale);
  const auto rounded = [](const ImageF& phase, float levels) {
    const ImageF whole = (phase * levels).round() / levels;
    return ImageF((whole < 1).select(whole, 0));
  };
  frame.phases[0] = rounded(frame.phases[0], levels_a);
  frame.phases[1] = rounded(frame.phases[1], levels_b);
  return frame;
}

TEST(Quantisation, IsTheStepOfThePhasesOfEachFrequency) {
  const std::vector<PhaseNoise> noise = estimate_phase_noise(rounded_slope(0.5, 64, 1000));
  EXPECT_NEAR(noise[0].quantisation_cycles, 1.0 / 64, 1e-6);
  EXPECT_NEAR(noise[1].quantisation_cycles, 1.0 / 1000, 1e-6);
}

TEST(Quantisation, OfPhasesThatAreNotRoundedIsThatOf16Bits) {
  const std::vector<PhaseNoise> noise = estimate_phase_noise(noisy_slope(2));
  EXPECT_LT(noise[0].quantisation_cycles, 1.0 / 8000);
  EXPECT_GE(noise[0].quantisation_cycles, 1.0 / 65535);
}

TEST(Quantisation, IsFoundWhereReturnsAreMissing) {
  Frame frame = rounded_slope(0.5, 64, 64);
  frame.phases[0].topRows(60).setConstant(NAN);
  EXPECT_NEAR(estimate_phase_noise(frame)[0].quantisation_cycles, 1.0 / 64, 1e-6);
}

TEST(Quantisation, OfAnImageOfOnePhaseIsNotFiner) {
  Frame frame = blank_frame(2);
  frame.phases[0] = frame.phases[1] = ImageF::Constant(20, 20, 0.5F);
  // Nothing is known of the step but that no camera's is coarser.
  EXPECT_DOUBLE_EQ(estimate_phase_noise(frame)[0].quantisation_cycles, 1.0 / 16);
}

TEST(PhaseNoise, IsAGuessWherePixelsAreTooFewToTell) {
  Frame frame = blank_frame(2);
  frame.phases[0] = frame.phases[1] = ImageF::Constant(1, 2, 0.5F);
  frame.amplitudes[0] = frame.amplitudes[1] = ImageF::Constant(1, 2, 50.0F);
  EXPECT_DOUBLE_EQ(estimate_phase_noise(frame)[0].scale, 0.01 * 50);
}

}  // namespace
}  // namespace tofmap
