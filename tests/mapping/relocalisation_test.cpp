// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <memory>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

using test::Scenery;

class LostCamera : public testing::Test {
 protected:
  static constexpr int first = 100;
  static constexpr int frames = 60;

  /// Follows the camera, covers it, and leaves it with few keyframes at hand, so that odometry
  /// cannot find places long ago by itself.
  LostCamera() : mapper_(room_.camera(), {.keyframes_around = 2}, {}, {}, {}) {
    for (int i = 0; i < frames; ++i) {
      EXPECT_TRUE(mapper_.add_frame({i, i / 15.0, room_.view(first + i)}).tracking.registered())
          << i;
    }
    const auto nothing = std::make_shared<const SurfaceCloud>();
    for (int i = frames; i < frames + 5; ++i) {
      EXPECT_FALSE(mapper_.add_frame({i, i / 15.0, nothing}).tracking.registered());
    }
  }

  TrackingResult track(int number, const std::shared_ptr<const SurfaceCloud>& cloud) {
    return mapper_.add_frame({number, number / 15.0, cloud}).tracking;
  }

  Scenery room_{"room"};
  RoomMapper mapper_;
};

TEST_F(LostCamera, IsFoundWhereItWasLongBefore) {
  const int there = first + 6;
  const TrackingResult found = track(frames + 5, room_.view(there));
  ASSERT_EQ(found.status, TrackingStatus::relocalised);
  const Pose truth = room_.pose(first).inverse() * room_.pose(there);
  EXPECT_LT((truth.inverse() * found.world_from_camera).translation().norm(), 0.02);
  // From there on it is followed again.
  for (int i = 1; i < 10; ++i) {
    const TrackingResult next = track(frames + 5 + i, room_.view(there + i));
    ASSERT_EQ(next.status, TrackingStatus::tracked) << i;
  }
  EXPECT_EQ(mapper_.trajectory().size(), frames + 10U) << "frames in between are not registered";
}

TEST_F(LostCamera, IsNotFoundInAnotherBuilding) {
  const Scenery flat("flat");
  for (int i = 5; i < 10; ++i) EXPECT_FALSE(track(frames + i, flat.view(50 + i)).registered());
}

TEST(CameraAfterAGap, IsFollowedOn) {
  constexpr int first = 100;
  const Scenery room("room");
  for (const int gap : {6, 10, 15}) {
    RoomMapper mapper(room.camera(), {}, {}, {}, {});
    for (int i = 0; i < 60; ++i) {
      if (i >= 30 && i < 30 + gap) continue;
      EXPECT_TRUE(mapper.add_frame({i, i / 15.0, room.view(first + i)}).tracking.registered()) << i;
    }
    const Pose truth = room.pose(first).inverse() * room.pose(first + 59);
    const Pose found = mapper.trajectory().back().world_from_camera;
    EXPECT_LT((truth.inverse() * found).translation().norm(), 0.02) << gap;
  }
}

}  // namespace
}  // namespace tofmap
