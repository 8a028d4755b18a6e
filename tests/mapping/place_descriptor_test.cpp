// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/keyframe.hpp>

namespace tofmap {
namespace {

using test::Scenery;

TEST(PlaceDescriptor, TellsPlacesApart) {
  const Scenery room("room");
  const PlaceDescriptor here(*room.view(100));
  EXPECT_EQ(here.difference(here), 0);
  const double near = here.difference(PlaceDescriptor(*room.view(102)));
  const double far = here.difference(PlaceDescriptor(*room.view(180)));
  EXPECT_LT(near, 0.1);
  EXPECT_GT(far, 2 * near);
  EXPECT_EQ(here.difference(PlaceDescriptor(*room.view(180))),
            PlaceDescriptor(*room.view(180)).difference(here));
}

TEST(PlaceDescriptor, OfNothingIsLikeNothing) {
  const Scenery room("room");
  SurfaceCloud nothing = *room.view(100);
  for (SurfacePoint& point : nothing.points) point.normal_z = NAN;
  EXPECT_TRUE(std::isinf(PlaceDescriptor(nothing).difference(PlaceDescriptor(*room.view(100)))));
}

TEST(PlaceDescriptor, FindsKeyframesThatLookAlike) {
  const Scenery room("room");
  std::vector<Keyframe> keyframes;
  for (int id = 0; id < 5; ++id) {
    keyframes.push_back({.id = id, .place = PlaceDescriptor(*room.view(60 * id))});
  }
  std::vector<const Keyframe*> all;
  for (const Keyframe& keyframe : keyframes) all.push_back(&keyframe);
  const auto found = most_alike(PlaceDescriptor(*room.view(123)), all, 2);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found.front()->id, 2);
  EXPECT_EQ(most_alike(PlaceDescriptor(), all, 9).size(), 5U) << "no more than there are";
}

}  // namespace
}  // namespace tofmap
