// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_ranges.hpp"

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/camera_travel.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// Map 1 at this place in map 0.
MapJoin shifted(double x_m) {
  return {
      .into = 0, .map = 1, .into_from_map = test::moved_by({0, 0, 0}, {x_m, 0, 0}), .edges = {}};
}

/// A camera that goes four metres in one map, is lost for as long, and begins another map.
std::vector<Stretch> lost_for(double gap_s) {
  std::vector<Stretch> stretches;
  for (int i = 0; i <= 40; ++i) add_position(stretches, 0, 0.1 * i, {0.1 * i, 0, 0});
  add_position(stretches, 1, 4 + gap_s, {0, 0, 0});
  add_position(stretches, 1, 5 + gap_s, {1, 0, 0});
  return stretches;
}

TEST(CameraTravel, IsAStretchAMap) {
  const auto stretches = lost_for(0.5);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].end_s, 4);
  EXPECT_EQ(stretches[0].end_m, Vector3d(4, 0, 0));
  EXPECT_EQ(stretches[1].map, 1);
  EXPECT_EQ(stretches[1].begin_s, 4.5);
  EXPECT_EQ(stretches[1].begin_m, Vector3d(0, 0, 0));
}

TEST(CameraTravel, IsPossibleFromWhereTrackingWasLost) {
  // Two metres: 1.5 m at 3 m/s, and what is tolerated.
  EXPECT_TRUE(can_travel(lost_for(0.5), shifted(4)));
  EXPECT_TRUE(can_travel(lost_for(0.5), shifted(5.9)));
  EXPECT_TRUE(can_travel(lost_for(0.5), shifted(2.1)));
  EXPECT_FALSE(can_travel(lost_for(0.5), shifted(6.1)));
  EXPECT_FALSE(can_travel(lost_for(0.5), shifted(0))) << "back where it began";
  EXPECT_TRUE(can_travel(lost_for(2), shifted(0)));
  EXPECT_TRUE(can_travel(lost_for(0.5), shifted(0), 3));
}

TEST(CameraTravel, GoesThroughOtherMaps) {
  // From map 0 by map 2, five metres long, to map 1: any order of the last two is as far.
  std::vector<Stretch> stretches;
  add_position(stretches, 0, 0, {0, 0, 0});
  add_position(stretches, 2, 0.1, {7, 7, 7});
  add_position(stretches, 2, 5, {7, 7, 12});
  add_position(stretches, 1, 5.1, {0, 0, 0});
  EXPECT_TRUE(can_travel(stretches, shifted(6.05)));
  EXPECT_TRUE(can_travel(stretches, shifted(-6.05)));
  EXPECT_FALSE(can_travel(stretches, shifted(6.15)));
}

TEST(CameraTravel, MustBePossibleBothWays) {
  auto stretches = lost_for(0.5);
  add_position(stretches, 0, 5.6, {0, 0, 0});  // back in map 0, far from where map 1 ends
  EXPECT_FALSE(can_travel(stretches, shifted(4)));
}

}  // namespace
}  // namespace tofmap
