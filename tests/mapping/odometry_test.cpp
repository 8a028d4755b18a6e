// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/odometry.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

const Vector3d odometry_room_min(-1.5, -1.0, -1);
const Vector3d odometry_room_max(2.0, 1.2, 4);

Pose camera_at(int frame) {
  return test::moved_by({0, 0.01 * frame, 0.004 * frame}, {0.02 * frame, 0, 0.01 * frame});
}

std::shared_ptr<const SurfaceCloud> view(int frame) {
  return std::make_shared<const SurfaceCloud>(test::box_cloud(
      test::small_camera(), odometry_room_min, odometry_room_max, camera_at(frame)));
}

/// Odometry with the keyframes it asks for, all of them around the camera.
class FollowedCamera {
 public:
  explicit FollowedCamera(const RegistrationOptions& registration = {})
      : odometry_(test::small_camera(), {}, registration, {}) {}

  TrackingResult track(int frame, const std::shared_ptr<const SurfaceCloud>& cloud) {
    std::vector<const Keyframe*> around;
    for (const Keyframe& keyframe : keyframes_) around.push_back(&keyframe);
    const TrackingResult result = odometry_.track(frame / 15.0, *cloud, around);
    if (result.registered() && is_far(result.world_from_camera)) {
      const int id = static_cast<int>(keyframes_.size());
      keyframes_.push_back({id, frame, frame / 15.0, result.world_from_camera, cloud});
    }
    return result;
  }

  void move(const Pose& new_from_old_world) {
    odometry_.move(new_from_old_world);
    for (Keyframe& keyframe : keyframes_) {
      keyframe.world_from_camera = new_from_old_world * keyframe.world_from_camera;
    }
  }

  std::size_t keyframe_count() const { return keyframes_.size(); }

 private:
  bool is_far(const Pose& pose) const {
    constexpr double step_m = 0.25;
    return std::ranges::none_of(keyframes_, [&](const Keyframe& keyframe) {
      return (keyframe.world_from_camera.translation() - pose.translation()).norm() < step_m;
    });
  }

  Odometry odometry_;
  std::vector<Keyframe> keyframes_;
};

double error_m(const TrackingResult& result, int frame, const Pose& world = Pose::Identity()) {
  return ((world * camera_at(frame)).inverse() * result.world_from_camera).translation().norm();
}

TEST(Odometry, FollowsASmoothMotion) {
  FollowedCamera camera;
  for (int frame = 0; frame < 30; ++frame) {
    const TrackingResult result = camera.track(frame, view(frame));
    ASSERT_TRUE(result.registered()) << "frame " << frame;
    EXPECT_LT(error_m(result, frame), 2e-3) << "frame " << frame;
  }
  // 2.2 cm and 0.6° a frame: a new keyframe every 0.25 m.
  EXPECT_GE(camera.keyframe_count(), 2U);
}

TEST(Odometry, KnowsWhichKeyframeHoldsTheCamera) {
  // The newer keyframe sees the far wall alone. Along it, the frame is known from the older one.
  const CameraModel camera = test::small_camera();
  const auto corner = view(0);
  const auto wall = std::make_shared<const SurfaceCloud>(
      test::box_cloud(camera, {-50, -50, -50}, {50, 50, odometry_room_max.z()}, Pose::Identity()));
  const Keyframe older{0, 0, 0, Pose::Identity(), corner};
  const Keyframe newer{1, 1, 1 / 15.0, Pose::Identity(), wall};
  const std::vector<const Keyframe*> around{&older, &newer};
  Odometry odometry(camera, {}, {}, {});
  odometry.track(0, *corner, {});
  odometry.note_keyframe(1);
  const TrackingResult result = odometry.track(1 / 15.0, *view(1), around);
  ASSERT_EQ(result.status, TrackingStatus::tracked);
  ASSERT_EQ(result.targets.size(), 2U);
  ASSERT_EQ(result.target_covariances.size(), 2U);
  const std::size_t of_older = result.targets[0] == 0 ? 0 : 1;
  const auto sideways_m = [&](std::size_t target) {
    return std::sqrt(result.target_covariances[target](3, 3));
  };
  EXPECT_LT(sideways_m(of_older), 0.005);
  // One frame since the newer one, of a camera that may have moved before: three times the prior of
  // the change of motion, and this change.
  EXPECT_NEAR(sideways_m(1 - of_older), std::sqrt(10) * OdometryOptions{}.prior_translation_sigma_m,
              0.005);
  ASSERT_TRUE(result.since_keyframe);
  EXPECT_EQ(result.since_keyframe->keyframe, 1);
  EXPECT_NEAR(std::sqrt(result.since_keyframe->covariance(3, 3)), sideways_m(1 - of_older), 0.001);
}

TEST(Odometry, KnowsTheMotionSinceTheLatestKeyframeWithoutSeeingIt) {
  const CameraModel camera = test::small_camera();
  const auto corner = view(0);
  const Keyframe older{0, 0, 0, Pose::Identity(), corner};
  const std::vector<const Keyframe*> around{&older};
  Odometry odometry(camera, {}, {}, {});
  odometry.track(0, *corner, {});
  EXPECT_FALSE(odometry.track(1 / 15.0, *view(0), around).since_keyframe) << "none is noted yet";
  odometry.note_keyframe(1);
  const TrackingResult result = odometry.track(2 / 15.0, *view(1), around);
  ASSERT_EQ(result.status, TrackingStatus::tracked);
  ASSERT_TRUE(result.since_keyframe);
  EXPECT_EQ(result.since_keyframe->keyframe, 1);
  EXPECT_GT(result.since_keyframe->covariance(3, 3), 100 * result.target_covariances[0](3, 3));
}

TEST(Odometry, FollowsWithPclsMethods) {
  // Points of pixels hold on to each other: point to point lags behind the camera.
  for (const auto& [method, most_m] : {std::pair(RegistrationMethod::pcl_icp, 0.15),
                                       std::pair(RegistrationMethod::pcl_gicp, 0.01)}) {
    RegistrationOptions options;
    options.method = method;
    FollowedCamera camera(options);
    for (int frame = 0; frame < 5; ++frame) {
      const TrackingResult result = camera.track(frame, view(frame));
      ASSERT_TRUE(result.registered()) << name_of(method) << ", frame " << frame;
      EXPECT_LT(error_m(result, frame), most_m) << name_of(method) << ", frame " << frame;
    }
  }
}

TEST(Odometry, SkipsAFrameWithoutSurfaceAndGoesOn) {
  FollowedCamera camera;
  for (int frame = 0; frame < 6; ++frame) camera.track(frame, view(frame));
  const auto empty = std::make_shared<const SurfaceCloud>();
  EXPECT_EQ(camera.track(6, empty).status, TrackingStatus::no_surface);
  const TrackingResult next = camera.track(7, view(7));
  ASSERT_TRUE(next.registered());
  EXPECT_LT(error_m(next, 7), 2e-3);
}

TEST(Odometry, StandsStillOnIdenticalFrames) {
  FollowedCamera camera;
  const auto cloud = view(0);
  for (int frame = 0; frame < 5; ++frame) {
    const TrackingResult result = camera.track(frame, cloud);
    ASSERT_TRUE(result.registered());
    EXPECT_LT(result.world_from_camera.translation().norm(), 1e-6);
  }
  EXPECT_EQ(camera.keyframe_count(), 1U);
}

TEST(Odometry, MovesWithItsKeyframes) {
  FollowedCamera camera;
  for (int frame = 0; frame < 15; ++frame) camera.track(frame, view(frame));
  const Pose elsewhere = test::moved_by({0, 0.3, 0}, {1, 2, 3});
  camera.move(elsewhere);
  const TrackingResult next = camera.track(15, view(15));
  ASSERT_TRUE(next.registered());
  EXPECT_LT(error_m(next, 15, elsewhere), 2e-3);
}

/// How a camera is followed that stands still for `still` frames in a box and then makes these
/// motions, one per frame.
void expect_followed(int still, const std::vector<Pose>& motions,
                     const Vector3d& box_min = odometry_room_min,
                     const Vector3d& box_max = odometry_room_max) {
  FollowedCamera camera;
  Pose pose = Pose::Identity();
  const auto seen = [&] {
    return std::make_shared<const SurfaceCloud>(
        test::box_cloud(test::small_camera(), box_min, box_max, pose));
  };
  for (int frame = 0; frame < still; ++frame) camera.track(frame, seen());
  int frame = still;
  for (const Pose& motion : motions) {
    pose = pose * motion;
    const TrackingResult result = camera.track(frame++, seen());
    ASSERT_TRUE(result.registered()) << "frame " << frame;
    EXPECT_LT((pose.inverse() * result.world_from_camera).translation().norm(), 5e-3)
        << "frame " << frame;
    EXPECT_LT(rotation_angle_rad(pose, result.world_from_camera), 2e-3) << "frame " << frame;
  }
}

Pose turned_by_deg(const Eigen::Vector3d& axis, double angle_deg, const Vector3d& moved_m) {
  return test::moved_by(angle_deg * std::numbers::pi / 180 * axis.normalized(), moved_m);
}

TEST(Odometry, FollowsACameraThatTurnsFromItsFirstFrame) {
  std::vector<Pose> motions;
  for (const double angle_deg : {17, 13, 9, 6}) {
    motions.push_back(turned_by_deg({0, 1, 0.1}, angle_deg, {0, 0, 0}));
  }
  expect_followed(1, motions);
}

TEST(Odometry, FollowsAStandingCameraThatTurnsBy20DegreesAndMovesBy30Centimetres) {
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = Vector3d::Unit(i);
    SCOPED_TRACE(axis.transpose());
    expect_followed(5, {turned_by_deg(axis, 20, {0.2, -0.1, 0.2}),
                        turned_by_deg(axis, -20, {-0.2, 0.1, -0.2})});
  }
}

TEST(Odometry, FollowsATurnBeforeAWallAlongWhichNothingShowsTheMotion) {
  const Vector3d corridor_min(-60, -1, -1);
  const Vector3d corridor_max(60, 1.2, 4);
  const Vector3d still(0, 0, 0);
  expect_followed(8, {turned_by_deg({0, 1, 0}, 18, still), turned_by_deg({0, 1, 0}, -18, still)},
                  corridor_min, corridor_max);
}

TEST(Odometry, DoesNotBelieveALeap) {
  FollowedCamera camera;
  for (int frame = 0; frame < 6; ++frame) camera.track(frame, view(frame));
  // Another place altogether: a box of another size.
  const auto elsewhere = std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), {-0.4, -0.5, -1}, {0.5, 0.4, 1.2}, Pose::Identity()));
  EXPECT_FALSE(camera.track(6, elsewhere).registered());
}

}  // namespace
}  // namespace tofmap
