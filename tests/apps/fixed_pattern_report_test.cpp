// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/fixed_pattern_report.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tofmap::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PatternEstimate significant_estimate(double periodic_share) {
  return {.error_m = ImageF::Constant(2, 3, 0.01F),
          .sigma_m = 0.01,
          .noise_m = 0.003,
          .remaining_m = 0.0028,
          .pixels = 6,
          .periodic_share = periodic_share};
}

PatternEstimate insignificant_estimate() {
  return {.error_m = ImageF::Zero(2, 3), .noise_m = 0.003, .pixels = 6, .periodic_share = 0.2};
}

TEST(FixedPatternReport, StoresWhatIsSignificantAndZerosForTheRest) {
  const FixedPattern pattern =
      stored_pattern({insignificant_estimate(), significant_estimate(0.2)}, false);
  ASSERT_EQ(pattern.size(), 2U);
  EXPECT_TRUE((pattern[0] == 0).all());
  EXPECT_TRUE((pattern[1] == 0.01F).all());
  EXPECT_TRUE(stored_pattern({insignificant_estimate(), insignificant_estimate()}, true).empty());
  EXPECT_TRUE(stored_pattern({}, true).empty());
}

TEST(FixedPatternReport, StoresPatternsOfOneRangeOnlyIfAsked) {
  const std::vector<PatternEstimate> still{significant_estimate(0.95)};
  EXPECT_TRUE(stored_pattern(still, false).empty());
  EXPECT_EQ(stored_pattern(still, true).size(), 1U);
  EXPECT_THAT(pattern_lines(still, false), ElementsAre(HasSubstr("left out")));
  EXPECT_THAT(pattern_lines(still, true),
              ElementsAre(HasSubstr("standard deviation 10.0 mm"), HasSubstr("warning")));
}

TEST(FixedPatternReport, NamesEachFrequencyWithItsFigures) {
  PatternEstimate unknown = insignificant_estimate();
  unknown.noise_m = NAN;
  EXPECT_THAT(
      pattern_lines({significant_estimate(0.2), insignificant_estimate(), unknown}, false),
      ElementsAre(
          "fixed pattern at A: standard deviation 10.0 mm over 6 pixels, known within 2.8 mm",
          "fixed pattern at B: none above its uncertainty of 3.0 mm",
          "fixed pattern at C: not found, since no pixel was measured twice"));
}

}  // namespace
}  // namespace tofmap::app
