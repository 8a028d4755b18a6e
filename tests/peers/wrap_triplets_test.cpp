// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/wrap_triplets.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap::peers {
namespace {

constexpr double speed_of_light_m_s = 299792458;
constexpr std::array<double, 3> kinect_hz{80e6, 16e6, 120e6};

TEST(WrapTriplets, TheKinectHasThirtyThatDiffer) {
  const WrapTriplets found = wrap_triplets(kinect_hz, speed_of_light_m_s);
  EXPECT_EQ(found.triplets.size(), 30U);
  EXPECT_EQ(std::set(found.triplets.begin(), found.triplets.end()).size(), 30U);
  EXPECT_EQ(found.multiplier, (std::array<double, 3>{3, 15, 2}));
  EXPECT_NEAR(found.non_ambiguity_range_m, 18.737, 0.001);
}

TEST(WrapTriplets, EveryRangeHasItsTriplet) {
  const WrapTriplets found = wrap_triplets(kinect_hz, speed_of_light_m_s);
  const std::set all(found.triplets.begin(), found.triplets.end());
  for (double range_m = 0.01; range_m < found.non_ambiguity_range_m; range_m += 0.0137) {
    WrapTriplet counts;
    for (std::size_t m = 0; m < 3; ++m)
      counts[m] = static_cast<std::uint8_t>(range_m * 2 * kinect_hz[m] / speed_of_light_m_s);
    EXPECT_TRUE(all.contains(counts)) << range_m;
  }
}

TEST(WrapTriplets, WhereTwoFrequenciesWrapTogetherEitherMayWrapFirst) {
  const WrapTriplets found = wrap_triplets(kinect_hz, speed_of_light_m_s);
  const std::set all(found.triplets.begin(), found.triplets.end());
  // 80 and 120 MHz wrap at 3.75 m, 80 and 16 MHz at 9.37 m.
  EXPECT_TRUE(all.contains(WrapTriplet{2, 0, 2}));
  EXPECT_TRUE(all.contains(WrapTriplet{1, 0, 3}));
  EXPECT_TRUE(all.contains(WrapTriplet{5, 0, 7}));
  EXPECT_TRUE(all.contains(WrapTriplet{4, 1, 7}));
}

TEST(WrapTriplets, FrequenciesWithoutCommonRangeAreRefused) {
  EXPECT_THROW(wrap_triplets({80e6, 16.001e6, 120e6}, speed_of_light_m_s), UsageError);
  EXPECT_THROW(wrap_triplets({0, 16e6, 120e6}, speed_of_light_m_s), UsageError);
}

}  // namespace
}  // namespace tofmap::peers
