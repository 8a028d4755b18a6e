// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "count_confidence.hpp"
#include "fast_math.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Pixels of one row, whose counts are believed in with these odds against.
CountBeliefs beliefs_against(const std::vector<float>& others) {
  const auto cols = static_cast<Eigen::Index>(others.size());
  CountBeliefs beliefs;
  beliefs.count = ImageU8::Ones(1, cols);
  beliefs.other_probability = ImageF(1, cols);
  for (Eigen::Index i = 0; i < cols; ++i) {
    beliefs.other_probability(i) = others[static_cast<std::size_t>(i)];
  }
  beliefs.probability = 1 - beliefs.other_probability;
  return beliefs;
}

TEST(CountConfidence, RisesWithTheOdds) {
  std::vector<float> others;
  for (double exponent = -0.05; exponent > -36; exponent -= 0.05) {
    others.push_back(static_cast<float>(std::pow(10, exponent)));
  }
  const ImageF confidence = count_confidence(beliefs_against(others));
  for (Eigen::Index i = 1; i < confidence.size(); ++i) {
    EXPECT_GE(confidence(i), confidence(i - 1)) << others[static_cast<std::size_t>(i)];
  }
  EXPECT_GT(confidence(0), 0);
  EXPECT_LE(confidence.maxCoeff(), 1);
}

TEST(CountConfidence, TellsBeliefsApartThatRoundToOne) {
  const ImageF confidence = count_confidence(beliefs_against({1e-9F, 1e-20F, 1e-30F}));
  EXPECT_LT(confidence(0), confidence(1));
  EXPECT_LT(confidence(1), confidence(2));
  // A step of the 16-bit images that confidences are written to.
  EXPECT_GT(confidence(2) - confidence(0), 1.0F / 65535);
}

TEST(CountConfidence, IsLessThanTheBelief) {
  for (const float other : {0.2F, 0.01F, 1e-4F, 1e-7F}) {
    EXPECT_LT(count_confidence(beliefs_against({other}))(0), 1 - other);
  }
}

TEST(CountConfidence, IsFiniteWithoutRivalsAndZeroWithoutACount) {
  CountBeliefs beliefs = beliefs_against({0, 0.5F});
  beliefs.count(1) = invalid_wrap_count;
  const ImageF confidence = count_confidence(beliefs);
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
