// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include <tofmap/mapping/moving_regions.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;
using CloudPointer = std::shared_ptr<const SurfaceCloud>;

const Vector3d room_min(-2.0, -1.2, -1);
const Vector3d room_max(2.0, 1.2, 4);

/// A box on the floor, half a metre wide, as high as a person; the y axis points down.
using Person = Eigen::AlignedBox3d;

Person person_at(double x, double z) {
  return {Vector3d(x - 0.25, -0.5, z - 0.15), Vector3d(x + 0.25, room_max.y(), z + 0.15)};
}

/// A view of the room, and which of its pixels see the person.
struct View {
  CloudPointer cloud;
  std::vector<char> sees_person;
};

View view_of(const std::optional<Person>& person, const Pose& world_from_camera) {
  const CameraModel camera = test::small_camera();
  RangeImage image = test::box_ranges(camera, room_min, room_max, world_from_camera);
  View view;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Vector3d ray = world_from_camera.linear() * pixel_ray(camera, u, v);
      const auto range =
          person ? test::range_to(*person, world_from_camera.translation(), ray) : std::nullopt;
      view.sees_person.push_back(range ? 1 : 0);
      if (range) image.range_m(v, u) = static_cast<float>(*range);
    }
  }
  view.cloud = std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(camera), {}));
  return view;
}

Keyframe keyframe_of(const View& view) { return {0, 0, 0, Pose::Identity(), view.cloud}; }

/// Shares of the points with a normal that are left, of the person and of the room.
struct Left {
  double of_person = 0;
  double of_room = 0;
};

Left left_in(const SurfaceCloud& cloud, const View& view) {
  std::array<double, 2> before{};
  std::array<double, 2> after{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto seen = static_cast<std::size_t>(view.sees_person[i]);
    before[seen] += view.cloud->points[i].has_normal() ? 1 : 0;
    after[seen] += cloud.points[i].has_normal() ? 1 : 0;
  }
  return {after[1] / std::max(1.0, before[1]), after[0] / std::max(1.0, before[0])};
}

Motion motion_between(const View& before, const View& now,
                      const Pose& world_from_camera = Pose::Identity(),
                      const PoseSpread& spread = {}) {
  const Keyframe keyframe = keyframe_of(before);
  const std::array<ComparedKeyframe, 1> keyframes{{{&keyframe, spread}}};
  return MovingRegions(test::small_camera()).find(now.cloud, world_from_camera, keyframes);
}

TEST(MovingRegions, AreLeftOutOfTheBackgroundWhetherTheyMoveOrNot) {
  const View view = view_of(person_at(0.3, 2), test::moved_by({0.02, -0.04, 0.01}, {0.1, 0, 0}));
  const MovingRegions regions(test::small_camera());
  const Left left = left_in(*regions.background(view.cloud), view);
  EXPECT_LT(left.of_person, 0.02);
  EXPECT_GT(left.of_room, 0.9);
  const View empty = view_of({}, Pose::Identity());
  EXPECT_EQ(regions.background(empty.cloud), empty.cloud);
}

TEST(MovingRegions, AreEmptyInARoomWhereNothingMoves) {
  const Pose moved = test::moved_by({0.02, -0.04, 0.01}, {0.1, -0.05, 0.08});
  const View now = view_of(person_at(0.3, 2), moved);
  const Motion motion = motion_between(view_of(person_at(0.3, 2), Pose::Identity()), now, moved);
  EXPECT_TRUE(motion.is_empty());
  EXPECT_EQ(motion.still, now.cloud);
}

TEST(MovingRegions, AreWhereSomebodyHasEnteredAnEmptyRoom) {
  const Pose moved = test::moved_by({0, -0.04, 0}, {0.1, 0, 0.08});
  const View now = view_of(person_at(0.3, 2), moved);
  const Motion motion = motion_between(view_of({}, Pose::Identity()), now, moved);
  EXPECT_TRUE(motion.keyframes.empty()) << "only what the person stands on is hidden";
  const Left left = left_in(*motion.still, now);
  EXPECT_LT(left.of_person, 0.02);
  EXPECT_GT(left.of_room, 0.97);
}

TEST(MovingRegions, KeepThePositionsOfWhatMoves) {
  const Pose moved = test::moved_by({0, -0.04, 0}, {0.1, 0, 0.08});
  const View now = view_of(person_at(0.3, 2), moved);
  const Motion motion = motion_between(view_of({}, Pose::Identity()), now, moved);
  int moving = 0;
  for (std::size_t i = 0; i < now.cloud->size(); ++i) {
    const SurfacePoint& point = motion.still->points[i];
    if (!moves(point)) continue;
    ++moving;
    ASSERT_FALSE(point.has_normal());
    ASSERT_EQ(point.getVector3fMap(), now.cloud->points[i].getVector3fMap());
  }
  EXPECT_GT(moving, std::ranges::count(now.sees_person, 1) / 2);
}

TEST(MovingRegions, AreWhereSomebodyWasBefore) {
  const View before = view_of(person_at(0.3, 2), Pose::Identity());
  const View now = view_of({}, Pose::Identity());
  const Motion motion = motion_between(before, now);
  EXPECT_EQ(left_in(*motion.still, now).of_room, 1);
  ASSERT_EQ(motion.keyframes.size(), 1U);
  const Left left = left_in(*motion.keyframes[0].cloud.load(), before);
  EXPECT_LT(left.of_person, 0.02);
  EXPECT_GT(left.of_room, 0.97);
}

TEST(MovingRegions, FollowSomebodyWhoWalksAwayFromTheCamera) {
  // The keyframe does not see through what the person covers now; the frame sees where it was.
  const View before = view_of(person_at(0, 2), Pose::Identity());
  const View now = view_of(person_at(0, 2.15), Pose::Identity());
  const Motion motion = motion_between(before, now);
  EXPECT_LT(left_in(*motion.still, now).of_person, 0.1);
  ASSERT_EQ(motion.keyframes.size(), 1U);
  EXPECT_LT(left_in(*motion.keyframes[0].cloud.load(), before).of_person, 0.1);
}

TEST(MovingRegions, ArePresumedToMoveOnForASecond) {
  const CameraModel camera = test::small_camera();
  const View now = view_of(person_at(0.3, 2), Pose::Identity());
  MovingRegions regions(camera);
  regions.remember(motion_between(view_of({}, Pose::Identity()), now));
  const View next = view_of(person_at(0.35, 2), Pose::Identity());
  EXPECT_LT(left_in(*regions.without_known(next.cloud, Pose::Identity()), next).of_person, 0.1);
  // From then on the person stands, and the keyframes that are left know no other room.
  const Keyframe keyframe = keyframe_of(next);
  const std::array<ComparedKeyframe, 1> keyframes{{{&keyframe, {}}}};
  int frames = 0;
  for (; frames < 100; ++frames) {
    const Motion motion = regions.find(next.cloud, Pose::Identity(), keyframes);
    if (motion.is_empty()) break;
    regions.remember(motion);
  }
  EXPECT_EQ(frames, 15);
}

TEST(MovingRegions, DoNotExplainAWrongPose) {
  const View before = view_of(person_at(0.3, 2), Pose::Identity());
  const Pose wrong = test::moved_by({0, 0, 0}, {0, 0, -0.3});
  const Motion motion = motion_between(before, before, wrong);
  EXPECT_TRUE(motion.is_empty());
  EXPECT_TRUE(motion.contradicts_pose);
}

TEST(MovingRegions, AreNoWallsThatAnUncertainPoseDisplaces) {
  // Off by 10 cm to the side: the walls at the sides seem to have moved, all others agree.
  const View view = view_of({}, Pose::Identity());
  const Pose displaced = test::moved_by({0, 0, 0}, {0.1, 0, 0});
  const auto motion_with = [&](const PoseSpread& spread) {
    return motion_between(view, view, displaced, spread);
  };
  EXPECT_FALSE(motion_with({}).is_empty());
  EXPECT_FALSE(motion_with({.rotation_rad2 = 1e-6, .translation_m2 = 1e-6}).is_empty());
  EXPECT_TRUE(motion_with({.rotation_rad2 = 0, .translation_m2 = 0.04 * 0.04}).is_empty());
  EXPECT_TRUE(motion_with({.rotation_rad2 = 0.02 * 0.02, .translation_m2 = 0}).is_empty());
}

TEST(MovingRegions, MayCoverMostOfTheViewIfTheyAreKnown) {
  // People side by side, who come nearer until they cover three quarters of the image.
  const auto people_at = [](double z) {
    return Person(Vector3d(-0.6, -1.1, z - 0.15), Vector3d(0.6, room_max.y(), z + 0.15));
  };
  const Keyframe keyframe = keyframe_of(view_of({}, Pose::Identity()));
  const std::array<ComparedKeyframe, 1> keyframes{{{&keyframe, {}}}};
  constexpr double nearest_m = 1.3;
  MovingRegions regions(test::small_camera());
  for (double z = 2.2; z > nearest_m; z -= 0.15) {
    const View now = view_of(people_at(z), Pose::Identity());
    const Motion motion = regions.find(now.cloud, Pose::Identity(), keyframes);
    ASSERT_FALSE(motion.contradicts_pose) << z;
    EXPECT_LT(left_in(*motion.still, now).of_person, 0.1) << z;
    regions.remember(motion);
  }
  const View last = view_of(people_at(nearest_m), Pose::Identity());
  EXPECT_TRUE(MovingRegions(test::small_camera())
                  .find(last.cloud, Pose::Identity(), keyframes)
                  .contradicts_pose)
      << "nothing is known of the people, so the pose may be wrong instead";
}

TEST(MovingRegions, AreNotForgottenWhileThePoseIsContradicted) {
  const View now = view_of(person_at(0.3, 2), Pose::Identity());
  MovingRegions regions(test::small_camera());
  regions.remember(motion_between(view_of({}, Pose::Identity()), now));
  const Motion contradicted{
      .still = now.cloud, .keyframes = {}, .points = {}, .contradicts_pose = true};
  int frames = 0;
  for (; frames < 100; ++frames) {
    if (regions.without_known(now.cloud, Pose::Identity()) == now.cloud) break;
    regions.remember(contradicted);
  }
  EXPECT_EQ(frames, 15);
}

TEST(MovingRegions, MoveWithTheWorld) {
  MovingRegions regions(test::small_camera());
  const View now = view_of(person_at(0.3, 2), Pose::Identity());
  regions.remember(motion_between(view_of({}, Pose::Identity()), now));
  const Pose new_from_old = test::moved_by({0, 1, 0}, {3, 0, 1});
  regions.move(new_from_old);
  EXPECT_LT(left_in(*regions.without_known(now.cloud, new_from_old), now).of_person, 0.1);
  EXPECT_EQ(regions.without_known(now.cloud, Pose::Identity()), now.cloud);
}

}  // namespace
}  // namespace tofmap
