// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pixel_errors.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

TEST(PixelSums, HaveTheWeightedMeanAndTheScatterAroundIt) {
  PixelSums sums;
  sums.add({.error_m = 0.1, .weight = 3}, 0);
  sums.add({.error_m = 0.5, .weight = 1}, 0);
  EXPECT_EQ(sums.count, 2);
  EXPECT_DOUBLE_EQ(sums.mean_m(), 0.2);
  EXPECT_DOUBLE_EQ(sums.scatter_m2(), 3 * 0.01 + 0.09);
}

TEST(PixelSums, TakeOutWhatIsProportionalToTheChange) {
  std::vector<PixelSums> pixels(2);
  for (int k = 0; k < 4; ++k) {
    const double change_m = 0.1 * (k % 3);
    pixels[0].add({.error_m = 0.02 + 0.7 * change_m, .change_m = change_m, .weight = 1.0 + k}, 0);
    pixels[1].add({.error_m = -0.01 + 0.7 * change_m, .change_m = change_m, .weight = 2}, 1);
  }
  EXPECT_NEAR(delay_of(pixels), 0.7, 1e-12);
  EXPECT_NEAR(pixels[0].mean_m(0.7), 0.02, 1e-12);
  EXPECT_NEAR(pixels[1].mean_m(0.7), -0.01, 1e-12);
  EXPECT_NEAR(pixels[0].scatter_m2(0.7), 0, 1e-12);
  EXPECT_GT(pixels[0].scatter_m2(), 0.001);
  EXPECT_EQ(delay_of(std::vector<PixelSums>(3)), 0) << "nothing changes";
}

TEST(PixelSums, KeepEachErrorWithTheSameProbability) {
  constexpr int pixels = 4000;
  std::vector<int> kept(4);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    PixelSums sums;
    for (int i = 0; i < 4; ++i) sums.add({.error_m = static_cast<double>(i)}, pixel);
    ++kept[static_cast<std::size_t>(sums.kept.error_m)];
  }
  // Standard deviation of the count: the square root of 4000 / 4 · 3 / 4; four times that.
  for (const int count : kept) EXPECT_NEAR(count, 1000, 110);
}

TEST(PixelNoise, IsThatOfSingleErrorsWhateverThePattern) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const int frames : {2, 3, 20}) {
    std::vector<PixelSums> pixels(20000);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double pattern_m = 0.05 * normal(random);
      const double relative = i % 2 == 0 ? 1 : 5;
      for (int k = 0; k < frames; ++k) {
        pixels[i].add({.error_m = pattern_m + 0.004 * relative * normal(random),
                       .relative_noise = relative,
                       .weight = 1 / (relative * relative)},
                      i);
      }
    }
    const SampleNoise noise = noise_of(pixels);
    // Of 5000 pixels in each quarter, median absolute deviations scatter by 1.2 %; four times that.
    EXPECT_NEAR(noise.noise_m(5), 0.02, 0.001) << frames;
    EXPECT_NEAR(std::sqrt(1 / noise.weight(1)), 0.004, 0.0003) << frames;
  }
}

TEST(PixelNoise, IsUnknownIfNoPixelHasTwoErrors) {
  std::vector<PixelSums> pixels(10);
  pixels[3].add({.error_m = 0.1}, 3);
  EXPECT_EQ(noise_of(pixels).weight(2), 0.25) << "a relative one";
}

}  // namespace
}  // namespace tofmap
