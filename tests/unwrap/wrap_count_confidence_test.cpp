// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/wrap_count_confidence.hpp"

#include "common/fast_math.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Pixels of one row, whose counts are believed in with these odds against.
WrapCountBeliefs beliefs_against(const std::vector<float>& others) {
  const auto cols = static_cast<Eigen::Index>(others.size());
  WrapCountBeliefs beliefs;
  beliefs.count = ImageU8::Ones(1, cols);
  beliefs.other_probability = ImageF(1, cols);
  for (Eigen::Index i = 0; i < cols; ++i) {
    beliefs.other_probability(i) = others[static_cast<std::size_t>(i)];
  }
  beliefs.probability = 1 - beliefs.other_probability;
  return beliefs;
}

/// The confidence where all pixels have this noise, a share of the residual step.
ImageF confidence_at(const WrapCountBeliefs& beliefs, float noise_share) {
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  const UnwrapLimits limits = unwrap_limits(sensor, 0);
  const double cycles = noise_share / residual_noise_steps(limits);
  return wrap_count_confidence(
      beliefs, ImageF(),
      ImageF::Constant(beliefs.count.rows(), beliefs.count.cols(), static_cast<float>(cycles)),
      limits);
}

/// Noise of all sizes, as shares of the residual step.
std::vector<float> noises() {
  std::vector<float> shares;
  for (float share = 1e-3F; share < 2000; share *= 1.3F) shares.push_back(share);
  return shares;
}

TEST(WrapCountConfidence, FallsWithJumpsOfTheRangeIfThereAreThreeFrequencies) {
  WrapCountBeliefs beliefs;
  beliefs.count = ImageU8::Ones(5, 7);
  beliefs.other_probability = ImageF::Constant(5, 7, 1e-12F);
  beliefs.probability = ImageF::Ones(5, 7);
  ImageF range_m = ImageF::Constant(5, 7, 4);
  range_m(2, 3) = 6;                                        // four jumps
  range_m.col(6).setConstant(5);                            // one jump
  range_m(0, 0) = std::numeric_limits<float>::quiet_NaN();  // no jump to where there is no range
  SensorModel sensor;
  const auto confidence_with = [&](std::vector<double> frequencies_hz) {
    sensor.modulation.frequencies_hz = std::move(frequencies_hz);
    return wrap_count_confidence(beliefs, range_m, ImageF::Constant(5, 7, 0.003F),
                                 unwrap_limits(sensor, 0));
  };
  const ImageF three = confidence_with({80e6, 16e6, 120e6});
  EXPECT_LT(three(2, 3), three(2, 2)) << "four jumps and one";
  EXPECT_LT(three(2, 2), three(4, 1)) << "one and none";
  EXPECT_EQ(three(1, 3), three(2, 2));
  EXPECT_EQ(three(2, 5), three(2, 6)) << "on both sides";
  EXPECT_EQ(three(0, 1), three(4, 1));
  EXPECT_EQ(three(4, 0), three(4, 1)) << "at the border";
  const ImageF two = confidence_with({80e6, 16e6});
  EXPECT_EQ(two.minCoeff(), two.maxCoeff());
}

TEST(WrapCountConfidence, RisesWithTheOdds) {
  std::vector<float> others;
  for (double exponent = -0.05; exponent > -36; exponent -= 0.05) {
    others.push_back(static_cast<float>(std::pow(10, exponent)));
  }
  for (const float noise : noises()) {
    const ImageF confidence = confidence_at(beliefs_against(others), noise);
    for (Eigen::Index i = 1; i < confidence.size(); ++i) {
      ASSERT_GE(confidence(i), confidence(i - 1))
          << others[static_cast<std::size_t>(i)] << " at " << noise;
    }
    EXPECT_GT(confidence(0), 0);
    EXPECT_LE(confidence.maxCoeff(), 1);
  }
}

TEST(WrapCountConfidence, ChangesLittleWithLittleNoise) {
  constexpr float largest_step = 0.12F;  // of the steepest curves, a tenth of an octave apart
  for (const float other : {0.5F, 1e-2F, 1e-4F, 1e-6F, 1e-12F}) {
    float before = confidence_at(beliefs_against({other}), 1e-3F)(0);
    for (float noise = 1e-3F; noise < 10; noise *= 1.07F) {
      const float now = confidence_at(beliefs_against({other}), noise)(0);
      EXPECT_NEAR(now, before, largest_step) << other << " at " << noise;
      before = now;
    }
  }
}

TEST(WrapCountConfidence, IsLessAtEdgesThatNoiseDoesNotExplain) {
  // Log odds of ten: an edge where noise is low, and half of what there is where it is not.
  const WrapCountBeliefs beliefs = beliefs_against({4.5e-5F});
  EXPECT_LT(confidence_at(beliefs, 0.03F)(0), 0.7F);
  EXPECT_GT(confidence_at(beliefs, 0.7F)(0), 0.9F);
}

TEST(WrapCountConfidence, TellsBeliefsApartThatRoundToOne) {
  const ImageF confidence = confidence_at(beliefs_against({1e-9F, 1e-20F, 1e-30F}), 0.3F);
  EXPECT_LT(confidence(0), confidence(1));
  EXPECT_LT(confidence(1), confidence(2));
  // A step of the 16-bit images that confidences are written to.
  EXPECT_GT(confidence(2) - confidence(0), 1.0F / 65535);
}

TEST(WrapCountConfidence, IsLessThanTheBelief) {
  for (const float other : {0.2F, 0.01F, 1e-4F, 1e-7F}) {
    EXPECT_LT(confidence_at(beliefs_against({other}), 0.3F)(0), 1 - other);
  }
}

TEST(WrapCountConfidence, IsFiniteWithoutRivalsAndZeroWithoutACount) {
  WrapCountBeliefs beliefs = beliefs_against({0, 0.5F});
  beliefs.count(1) = invalid_wrap_count;
  const ImageF confidence = confidence_at(beliefs, 0.3F);
  EXPECT_GT(confidence(0), 0.999F);
  EXPECT_LE(confidence(0), 1);
  EXPECT_EQ(confidence(1), 0);
}

TEST(FastMath, LogarithmIsThatOfTheLibrary) {
  for (double exponent = -37; exponent < 37; exponent += 0.01) {
    const auto x = static_cast<float>(std::pow(10, exponent));
    EXPECT_NEAR(log2_of(x), std::log2(static_cast<double>(x)), 1e-5) << x;  // rounding at 123
  }
}

}  // namespace
}  // namespace tofmap
