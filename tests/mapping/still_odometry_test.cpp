// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/still_odometry.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;
using CloudPointer = std::shared_ptr<const SurfaceCloud>;

/// A camera that moves slowly through a room.
Pose slow_camera_at(int frame) {
  return test::moved_by({0, 0.005 * frame, 0}, {0.01 * frame, 0, 0.01 * frame});
}

/// What the camera sees of the room and of a person, a box on the floor at (x, z), if there is one.
CloudPointer room_view(int frame, const std::optional<Eigen::Vector2d>& person) {
  const Vector3d room_min(-2, -1.2, -1);
  const Vector3d room_max(2, 1.2, 4);
  const CameraModel camera = test::small_camera();
  const Pose pose = slow_camera_at(frame);
  RangeImage image = test::box_ranges(camera, room_min, room_max, pose);
  for (int v = 0; person && v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::AlignedBox3d body(
          Vector3d(person->x() - 0.25, -0.5, person->y() - 0.15),
          Vector3d(person->x() + 0.25, room_max.y(), person->y() + 0.15));
      const auto range_m =
          test::range_to(body, pose.translation(), pose.linear() * pixel_ray(camera, u, v));
      if (range_m) image.range_m(v, u) = static_cast<float>(*range_m);
    }
  }
  return std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(camera), {}));
}

/// Tracks with the first frame as the only keyframe.
class StillCamera {
 public:
  explicit StillCamera(const OdometryOptions& options = {})
      : odometry_(test::small_camera(), options, {}, {}) {}

  StillTracking track(int frame, const CloudPointer& cloud) {
    std::vector<const Keyframe*> around;
    for (const Keyframe& keyframe : keyframes_.all()) around.push_back(&keyframe);
    StillTracking found = odometry_.track(frame / 15.0, cloud, around, around, keyframes_);
    odometry_.note_frame(frame / 15.0);
    if (keyframes_.size() == 0) {
      keyframes_.add({0, frame, 0, found.tracking.world_from_camera, cloud});
    }
    return found;
  }

  const Keyframe& keyframe() const { return keyframes_[0]; }

 private:
  StillOdometry odometry_;
  KeyframeGraph keyframes_;
};

double error_of(const StillTracking& found, int frame) {
  const Pose error = slow_camera_at(frame).inverse() * found.tracking.world_from_camera;
  return error.translation().norm();
}

std::ptrdiff_t count_moving(const SurfaceCloud& cloud) {
  return std::ranges::count_if(cloud.points, moves);
}

TEST(StillOdometry, LeavesNothingOutOfAStillRoom) {
  StillCamera camera;
  for (int frame = 0; frame < 5; ++frame) {
    const CloudPointer cloud = room_view(frame, Eigen::Vector2d(0.3, 2));
    const StillTracking found = camera.track(frame, cloud);
    ASSERT_TRUE(found.tracking.registered());
    EXPECT_EQ(found.still, cloud);
    EXPECT_LT(error_of(found, frame), 0.002);
  }
}

TEST(StillOdometry, LeavesOutSomebodyWhoComesIn) {
  StillCamera camera;
  camera.track(0, room_view(0, {}));
  for (int frame = 1; frame < 8; ++frame) {
    const Eigen::Vector2d person(-0.8 + 0.1 * frame, 2);
    const StillTracking found = camera.track(frame, room_view(frame, person));
    ASSERT_TRUE(found.tracking.registered());
    EXPECT_GT(count_moving(*found.still), 100);
    EXPECT_LT(error_of(found, frame), 0.002);
  }
  EXPECT_EQ(count_moving(*camera.keyframe().cloud.load()), 0) << "nobody was there";
}

TEST(StillOdometry, TakesSomebodyWhoLeavesOutOfTheKeyframe) {
  StillCamera camera;
  camera.track(0, room_view(0, Eigen::Vector2d(0.3, 2)));
  const StillTracking found = camera.track(1, room_view(1, {}));
  ASSERT_TRUE(found.tracking.registered());
  EXPECT_EQ(count_moving(*found.still), 0);
  EXPECT_GT(count_moving(*camera.keyframe().cloud.load()), 100);
}

TEST(StillOdometry, TracksAFrameInWhichSomebodyCoversMuchOfTheRoom) {
  const Eigen::Vector2d near_person(0, 1);
  StillCamera camera;
  camera.track(0, room_view(0, {}));
  const StillTracking found = camera.track(1, room_view(1, near_person));
  ASSERT_TRUE(found.tracking.registered());
  EXPECT_GT(count_moving(*found.still), 1500);
  EXPECT_LT(error_of(found, 1), 0.002);
  EXPECT_EQ(count_moving(*camera.keyframe().cloud.load()), 0);
  // Without the search for what moves, the person contradicts the free space of the keyframe.
  StillCamera unaware({.leave_out_moving = false});
  unaware.track(0, room_view(0, {}));
  EXPECT_EQ(unaware.track(1, room_view(1, near_person)).tracking.status, TrackingStatus::lost);
}

TEST(StillOdometry, IsOdometryAloneIfTheOptionsSaySo) {
  OdometryOptions options;
  options.leave_out_moving = false;
  StillCamera camera(options);
  camera.track(0, room_view(0, {}));
  const CloudPointer cloud = room_view(1, Eigen::Vector2d(0.3, 2));
  EXPECT_EQ(camera.track(1, cloud).still, cloud);
}

TEST(StillOdometry, SaysNothingMovesIfThereIsNothingToCompareWith) {
  KeyframeGraph keyframes;
  StillOdometry odometry(test::small_camera(), {}, {}, {});
  const CloudPointer empty = room_view(0, {});
  keyframes.add({0, 0, 0, Pose::Identity(), empty});
  odometry.track(0, empty, {}, {}, keyframes);
  const std::vector<const Keyframe*> around{&keyframes[0]};
  const CloudPointer cloud = room_view(1, Eigen::Vector2d(0.3, 2));
  const StillTracking found = odometry.track(1 / 15.0, cloud, around, {}, keyframes);
  EXPECT_TRUE(found.tracking.registered());
  EXPECT_EQ(found.still, cloud);
}

}  // namespace
}  // namespace tofmap
