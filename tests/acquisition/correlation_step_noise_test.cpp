// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/acquisition/correlation/step_fit.hpp>
#include <tofmap/acquisition/correlation/step_noise.hpp>

namespace tofmap {
namespace {

constexpr int noisy_rows = 300;
constexpr int noisy_cols = 400;

/// What a camera measures of an image whose amplitude grows from left to right.
struct Measured {
  StepDesign design;
  StepFit fit;
};

/// `variance` is that of a pixel with this offset b; `change` is added to the value of a step.
Measured measured(int steps, const std::function<double(double offset)>& variance,
                  const std::function<double(int step, int row, int col)>& change) {
  std::vector<double> angles;
  for (int k = 0; k < steps; ++k) angles.push_back(2 * std::numbers::pi * k / steps);
  std::mt19937 random(11);
  std::normal_distribution<double> unit_noise;
  std::vector<ImageF> images;
  for (int k = 0; k < steps; ++k) {
    ImageF image(noisy_rows, noisy_cols);
    for (int row = 0; row < noisy_rows; ++row) {
      for (int col = 0; col < noisy_cols; ++col) {
        const double amplitude = 50 + 5.0 * col;
        const double offset = 2 * amplitude;
        const double angle = 0.02 * row + 0.05 * col - angles[static_cast<std::size_t>(k)];
        const double value = offset + amplitude * std::cos(angle) + change(k, row, col) +
                             std::sqrt(variance(offset)) * unit_noise(random);
        image(row, col) = static_cast<float>(value);
      }
    }
    images.push_back(image);
  }
  StepDesign design(angles, true);
  StepFit fit = fit_steps(images, design);
  return {design, fit};
}

double no_change(int, int, int) { return 0; }
double noise_of_a_camera(double offset) { return 4 + 0.5 * offset; }

StepNoise noise_of(const Measured& made, double least_variance = 0) {
  return estimate_step_noise(made.fit.offset, made.fit.squared_residual,
                             ImageU8::Zero(noisy_rows, noisy_cols),
                             made.design.degrees_of_freedom(), least_variance);
}

ImageU8 flags_of(const Measured& made) {
  return inconsistent_pixels(made.fit.offset, made.fit.squared_residual, noise_of(made),
                             made.design.degrees_of_freedom());
}

int count(const ImageU8& flags) { return flags.cast<int>().sum(); }

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4.
  EXPECT_NEAR(chi_square_quantile(1, 0.05), 3.841, 5e-4);
  EXPECT_NEAR(chi_square_quantile(1, 0.001), 10.828, 5e-4);
  EXPECT_NEAR(chi_square_quantile(2, 0.001), 13.816, 5e-4);
  EXPECT_NEAR(chi_square_quantile(5, 0.01), 15.086, 5e-4);
  EXPECT_NEAR(chi_square_quantile(10, 0.1), 15.987, 5e-4);
  EXPECT_NEAR(chi_square_quantile(61, 0.05), 80.232, 5e-4);
  EXPECT_NEAR(chi_square_quantile(1, 0.5), 0.45494, 5e-5) << "the square of the normal median";
}

TEST(StepNoise, IsThatOfReadoutAndShotNoise) {
  for (const int steps : {4, 5, 8}) {
    const StepNoise noise = noise_of(measured(steps, noise_of_a_camera, no_change));
    for (const double offset : {100.0, 1000.0, 4000.0}) {
      EXPECT_NEAR(noise.variance_at(offset) / noise_of_a_camera(offset), 1, 0.1) << steps;
    }
  }
}

TEST(StepNoise, AloneMakesOnePixelIn10000Inconsistent) {
  for (const int steps : {4, 8}) {
    const int flagged = count(flags_of(measured(steps, noise_of_a_camera, no_change)));
    // 12 of 120 000 pixels are expected. The noise is known to some percent, which changes that
    // number by up to a half.
    EXPECT_GE(flagged, 3) << steps;
    EXPECT_LE(flagged, 30) << steps;
  }
}

TEST(StepNoise, IsNotRaisedByAThirdOfMovingPixels) {
  const auto moves = [](int row) { return row < noisy_rows / 3; };
  // What moves changes one of the steps, by 15 standard deviations.
  const auto change = [&](int step, int row, int col) {
    return step == 2 && moves(row) ? 15 * std::sqrt(noise_of_a_camera(100 + 10.0 * col)) : 0;
  };
  const ImageU8 flags = flags_of(measured(4, noise_of_a_camera, change));
  EXPECT_GT(count(flags.topRows(noisy_rows / 3)), 0.95 * noisy_cols * noisy_rows / 3);
  EXPECT_LT(count(flags.bottomRows(noisy_rows - noisy_rows / 3)), 40);
}

TEST(StepNoise, IsNotRaisedByABrightObjectThatMoves) {
  const auto change = [](int step, int, int col) {
    return step == 1 && col >= noisy_cols * 9 / 10
               ? 15 * std::sqrt(noise_of_a_camera(100 + 10.0 * col))
               : 0;
  };
  const ImageU8 flags = flags_of(measured(4, noise_of_a_camera, change));
  EXPECT_GT(count(flags.rightCols(noisy_cols / 10)), 0.95 * noisy_rows * noisy_cols / 10);
}

TEST(StepNoise, TakesInHarmonicsOfTheCorrelationFunction) {
  // A third harmonic of 5 % of the amplitude, many times the noise of bright pixels.
  const auto change = [](int step, int row, int col) {
    const double angle = 0.02 * row + 0.05 * col - 2 * std::numbers::pi * step / 8;
    return 0.05 * (50 + 5.0 * col) * std::cos(3 * angle);
  };
  const ImageU8 flags = flags_of(measured(
      8, [](double) { return 4; }, change));
  EXPECT_LT(count(flags), 0.001 * noisy_rows * noisy_cols);
}

TEST(StepNoise, IsAtLeastThatOfRounding) {
  const Measured made = measured(
      4, [](double) { return 0; }, no_change);
  EXPECT_GE(noise_of(made, 1.0 / 12).variance_at(0), 1.0 / 12);
}

TEST(StepNoise, OfTooFewPixelsIsUnknownAndFlagsNone) {
  const ImageF signal = ImageF::Ones(5, 5);
  const ImageF squares = ImageF::Constant(5, 5, 1e9F);
  const StepNoise noise = estimate_step_noise(signal, squares, ImageU8::Zero(5, 5), 1, 1);
  EXPECT_EQ(noise.pixels, 0);
  EXPECT_EQ(count(inconsistent_pixels(signal, squares, noise, 1)), 0);
  const ImageF many = ImageF::Ones(20, 20);
  EXPECT_EQ(estimate_step_noise(many, many, ImageU8::Ones(20, 20), 1, 1).pixels, 0)
      << "all excluded";
}

}  // namespace
}  // namespace tofmap
