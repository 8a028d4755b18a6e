// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/odometry.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

const Vector3d room_min(-1.5, -1.0, -1);
const Vector3d room_max(2.0, 1.2, 4);

Pose camera_at(int frame) {
  return test::moved_by({0, 0.01 * frame, 0.004 * frame}, {0.02 * frame, 0, 0.01 * frame});
}

std::shared_ptr<const SurfaceCloud> view(int frame) {
  return std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), room_min, room_max, camera_at(frame)));
}

TEST(Odometry, FollowsASmoothMotion) {
  Odometry odometry(test::small_camera(), {}, {});
  for (int frame = 0; frame < 30; ++frame) {
    const TrackingResult result = odometry.track(frame, frame / 15.0, view(frame));
    ASSERT_TRUE(result.placed()) << "frame " << frame;
    const Pose error = camera_at(frame).inverse() * result.world_from_camera;
    EXPECT_LT(error.translation().norm(), 2e-3) << "frame " << frame;
  }
  // 2.2 cm and 0.6° a frame: a new keyframe every 0.25 m.
  EXPECT_GE(odometry.keyframe_count(), 2);
}

TEST(Odometry, SkipsAFrameWithoutSurfaceAndGoesOn) {
  Odometry odometry(test::small_camera(), {}, {});
  for (int frame = 0; frame < 6; ++frame) odometry.track(frame, frame / 15.0, view(frame));
  const auto empty = std::make_shared<const SurfaceCloud>();
  EXPECT_EQ(odometry.track(6, 6 / 15.0, empty).status, TrackingStatus::no_surface);
  const TrackingResult next = odometry.track(7, 7 / 15.0, view(7));
  ASSERT_TRUE(next.placed());
  EXPECT_LT((camera_at(7).inverse() * next.world_from_camera).translation().norm(), 2e-3);
}

TEST(Odometry, StandsStillOnIdenticalFrames) {
  Odometry odometry(test::small_camera(), {}, {});
  const auto cloud = view(0);
  for (int frame = 0; frame < 5; ++frame) {
    const TrackingResult result = odometry.track(frame, frame / 15.0, cloud);
    ASSERT_TRUE(result.placed());
    EXPECT_LT(result.world_from_camera.translation().norm(), 1e-6);
  }
  EXPECT_EQ(odometry.keyframe_count(), 1);
}

TEST(Odometry, MovesWithItsKeyframes) {
  Odometry odometry(test::small_camera(), {}, {});
  for (int frame = 0; frame < 15; ++frame) odometry.track(frame, frame / 15.0, view(frame));
  const Pose elsewhere = test::moved_by({0, 0.3, 0}, {1, 2, 3});
  std::vector<Pose> corrected;
  for (const Keyframe& keyframe : odometry.recent_keyframes()) {
    ASSERT_EQ(keyframe.id, static_cast<int>(corrected.size()));
    corrected.push_back(elsewhere * keyframe.world_from_camera);
  }
  odometry.correct(corrected);
  const TrackingResult next = odometry.track(15, 15 / 15.0, view(15));
  ASSERT_TRUE(next.placed());
  const Pose error = (elsewhere * camera_at(15)).inverse() * next.world_from_camera;
  EXPECT_LT(error.translation().norm(), 2e-3);
}

TEST(Odometry, DoesNotBelieveALeap) {
  Odometry odometry(test::small_camera(), {}, {});
  for (int frame = 0; frame < 6; ++frame) odometry.track(frame, frame / 15.0, view(frame));
  // Another place altogether: a box of another size.
  const auto elsewhere = std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), {-0.4, -0.5, -1}, {0.5, 0.4, 1.2}, Pose::Identity()));
  EXPECT_FALSE(odometry.track(6, 6 / 15.0, elsewhere).placed());
}

}  // namespace
}  // namespace tofmap
