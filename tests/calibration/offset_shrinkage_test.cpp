// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "offset_shrinkage.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// Values drawn around a mean of 3 with this variance, each with noise of the variance that
/// `noise_of` gives for its index.
template <class NoiseOf>
std::vector<MeasuredOffset> drawn(std::size_t count, double variance, const NoiseOf& noise_of) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<MeasuredOffset> offsets;
  for (std::size_t i = 0; i < count; ++i) {
    const double noise = noise_of(i);
    offsets.push_back(
        {3 + std::sqrt(variance) * normal(random) + std::sqrt(noise) * normal(random), noise});
  }
  return offsets;
}

TEST(OffsetDistribution, IsTheVarianceWithoutNoiseIfAllNoiseIsTheSame) {
  const std::vector<MeasuredOffset> offsets = drawn(5000, 2, [](std::size_t) { return 0.7; });
  double mean = 0;
  for (const MeasuredOffset& one : offsets) mean += one.value / 5000;
  double variance = 0;
  for (const MeasuredOffset& one : offsets) variance += std::pow(one.value - mean, 2) / 4999;
  const OffsetDistribution found = distribution_of(offsets);
  EXPECT_NEAR(found.mean, mean, 1e-9);
  EXPECT_NEAR(found.variance, variance - 0.7, 1e-9);
}

TEST(OffsetDistribution, IsFoundThroughValuesOfVeryDifferentNoise) {
  const std::vector<MeasuredOffset> offsets =
      drawn(20000, 2, [](std::size_t i) { return i % 4 == 0 ? 400 : 0.1; });
  const OffsetDistribution found = distribution_of(offsets);
  // 15000 values of use: 2.1 times the square root of 2 / 15000 is 0.024; four times that.
  EXPECT_NEAR(found.variance, 2, 0.1);
  EXPECT_NEAR(found.mean, 3, 0.05);
}

TEST(OffsetDistribution, IsNoneWhereNoiseExplainsTheSpread) {
  const OffsetDistribution found =
      distribution_of(drawn(20000, 0, [](std::size_t i) { return 1 + i % 3; }));
  EXPECT_EQ(found.variance, 0);
  EXPECT_NEAR(found.mean, 3, 0.05);
  EXPECT_EQ(found.shrunk({10, 1}), 0);
  EXPECT_EQ(found.remaining_variance({10, 1}), 0);
}

TEST(OffsetDistribution, NeedsMoreSpreadIfValuesAreFew) {
  const auto noise = [](std::size_t) { return 1.0; };
  EXPECT_GT(distribution_of(drawn(20000, 0.4, noise)).variance, 0);
  EXPECT_EQ(distribution_of(drawn(100, 0.4, noise)).variance, 0);
}

TEST(OffsetDistribution, OfNoValuesOrOneHasNoVariance) {
  EXPECT_EQ(distribution_of({}).variance, 0);
  const std::vector<MeasuredOffset> one{{2, 1}};
  EXPECT_EQ(distribution_of(one).variance, 0);
  EXPECT_EQ(distribution_of(one).mean, 2);
}

TEST(OffsetDistribution, ShrinksByTheShareOfNoise) {
  const OffsetDistribution distribution{.mean = 1, .variance = 3};
  EXPECT_DOUBLE_EQ(distribution.shrunk({5, 1}), 3);
  EXPECT_DOUBLE_EQ(distribution.remaining_variance({5, 1}), 0.75);
}

}  // namespace
}  // namespace tofmap
