// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The search for an offset between the frequencies, on samples whose ranges and offset are known.

#include "errors/constant_search.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr ConstantPrior prior{.constant_m = 0.06, .systematic_m = 0.02, .correlated_samples = 6};

PairLimits limits_of(double frequency_a_hz, double frequency_b_hz) {
  SensorModel sensor;
  sensor.modulation = {frequency_a_hz, frequency_b_hz};
  return unwrap_limits(sensor, 15).pair(0, 1);
}

constexpr int samples_of_frame = 300;

/// Surfaces from `nearest_m` to 9 m, whose light falls with the square of the range; A's ranges
/// exceed B's by `offset_m`.
PredictedSamples samples_of(const PairLimits& limits, double nearest_m, double offset_m,
                            double noise_m) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  PredictedSamples samples;
  for (int i = 0; i < samples_of_frame; ++i) {
    const double range_m = nearest_m + (9 - nearest_m) * i / samples_of_frame;
    const double albedo = std::exp(0.3 * normal(random));
    const auto phase = [](double cycles) {
      return static_cast<float>(cycles - std::floor(cycles));
    };
    samples.phase_a.push_back(
        phase((range_m + offset_m + noise_m * normal(random)) / limits.wavelength_a_m));
    samples.phase_b.push_back(phase((range_m + noise_m * normal(random)) / limits.wavelength_b_m));
    samples.amplitude_a.push_back(static_cast<float>(albedo / (range_m * range_m)));
    samples.predicted_m.push_back(0);
    samples.variance_m2.push_back(static_cast<float>(2 * noise_m * noise_m));
  }
  return samples;
}

TEST(ConstantSearch, FindsAnOffset) {
  const PairLimits limits = limits_of(29e6, 31e6);
  for (const double offset_m : {-0.12, -0.05, 0.0, 0.05, 0.12}) {
    const PredictedSamples samples = samples_of(limits, 1, offset_m, 0.02);
    // Constants are a centimetre apart, and the prior pulls toward zero by less than another.
    EXPECT_NEAR(likeliest_constant_m(limits, prior, samples), offset_m, 0.02) << offset_m;
  }
}

TEST(ConstantSearch, TellsAnOffsetFromItsAliasByTheLight) {
  // Another wrap count changes the residual by 21 cm, so −9 cm explain the residuals as well as
  // 11.5 cm, and are likelier. But for the same amplitudes a wavelength nearer,
  // the nearest surfaces would have to reflect much less than the others.
  const PairLimits limits = limits_of(29e6, 30.2e6);
  ASSERT_NEAR(residual_step_m(limits), 0.205, 0.001);
  PredictedSamples samples = samples_of(limits, 6, 0.115, 0.01);
  EXPECT_NEAR(likeliest_constant_m(limits, prior, samples), 0.115, 0.02);
  samples.amplitude_a.clear();
  EXPECT_NEAR(likeliest_constant_m(limits, prior, samples), -0.09, 0.02);
}

TEST(ConstantSearch, KeepsZeroWithoutSamples) {
  EXPECT_EQ(likeliest_constant_m(limits_of(29e6, 31e6), prior, {}), 0);
}

}  // namespace
}  // namespace tofmap
