// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_noise.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr int values_count = 40000;

/// The standard error of a robust standard deviation from a quarter of the values is 1.2 % (1.17 /
/// sqrt(10000)); four of them.
constexpr double tolerance = 0.05;

/// Values about 5 m with a common floor and noises in an even spread of relative sizes.
std::vector<NoisyValue> values_of(double unit_m, double floor_m, double least, double most) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> relative(least, most);
  std::vector<NoisyValue> values;
  for (int i = 0; i < values_count; ++i) {
    const double noise = relative(random);
    const double value_m = 5 + unit_m * noise * normal(random) + floor_m * normal(random);
    values.push_back({static_cast<float>(noise), static_cast<float>(value_m)});
  }
  return values;
}

TEST(SampleNoise, SeparatesNoiseFromWhatAllValuesShare) {
  const SampleNoise found = estimate_noise(values_of(0.003, 0.01, 1, 10));
  // Each quarter is taken at its median noise, which underestimates the mean of its squares by
  // less than a tenth.
  EXPECT_NEAR(found.unit_m, 0.003, 0.1 * 0.003);
  EXPECT_NEAR(found.floor_m, 0.01, 0.1 * 0.01);
}

TEST(SampleNoise, OfEquallyNoisyValuesIsAllOfTheirSpread) {
  // 3 · 0.004 m and a floor of 0.009 m are 0.015 m together.
  const SampleNoise found = estimate_noise(values_of(0.004, 0.009, 2.9, 3.1));
  EXPECT_NEAR(found.noise_m(3), 0.015, tolerance * 0.015);
  EXPECT_EQ(found.floor_m, 0.001);
}

TEST(SampleNoise, OfUpToHalfMoreNoiseIsNotSeparated) {
  // The noisiest quarter has 1.4 times the noise of the least noisy one, below the ratio of 1.5.
  const SampleNoise found = estimate_noise(values_of(0.004, 0.02, 1, 1.52));
  EXPECT_EQ(found.floor_m, 0.001);
  const SampleNoise separated = estimate_noise(values_of(0.004, 0.02, 1, 2.2));
  EXPECT_GT(separated.floor_m, 0.015);
}

TEST(SampleNoise, IsNeverNegative) {
  // Values whose spread falls with the noise that they claim.
  std::vector<NoisyValue> values = values_of(0, 0.03, 1, 2);
  for (NoisyValue& one : values_of(0, 0.003, 8, 9)) values.push_back(one);
  const SampleNoise found = estimate_noise(values);
  EXPECT_EQ(found.unit_m, 0);
  EXPECT_NEAR(found.floor_m, 0.03, tolerance * 0.03);
}

TEST(SampleNoise, IsNotMisledByAFewWildValues) {
  std::vector<NoisyValue> values = values_of(0.004, 0, 2.9, 3.1);
  for (std::size_t i = 0; i < values.size(); i += 50) values[i].value_m = 40;
  EXPECT_NEAR(estimate_noise(values).noise_m(3), 0.012, 2 * tolerance * 0.012);
}

TEST(SampleNoise, OfASingleValueHasTheLeastFloor) {
  const SampleNoise found = estimate_noise({{2, 5}});
  EXPECT_EQ(found.unit_m, 0);
  EXPECT_EQ(found.floor_m, 0.001);
}

TEST(SampleNoise, WeighsByTheInverseOfTheWholeVariance) {
  const SampleNoise noise{.unit_m = 0.003, .floor_m = 0.004};
  EXPECT_NEAR(noise.weight(1), 1 / (0.005 * 0.005), 1e-6);
}

}  // namespace
}  // namespace tofmap
