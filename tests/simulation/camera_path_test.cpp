// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/camera_path.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr MotionLimits limits{0.07, 0.0524};

CameraPath square_path() {
  return {{{{0, 0, 1}, {1, 0, 0}},
           {{3, 0, 1}, {0, 1, 0}},
           {{3, 3, 1}, {-1, 0, 0}},
           {{0, 3, 1}, {0, -1, 0}}},
          true};
}

CameraPath straight_path(double length_m) {
  return {{{{0, 0, 1}, {1, 0, 0}}, {{length_m, 0, 1}, {1, 0, 0}}}, false};
}

double largest_translation_m(const Trajectory& poses) {
  double largest = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    largest = std::max(largest, (poses[i].world_from_camera.translation() -
                                 poses[i - 1].world_from_camera.translation())
                                    .norm());
  }
  return largest;
}

TEST(LookAlong, PutsZAheadXRightAndYDown) {
  const Pose pose = look_along({1, 2, 3}, {0, 5, 0});
  EXPECT_TRUE(pose.translation().isApprox(Vector3d(1, 2, 3)));
  EXPECT_TRUE(pose.linear().col(2).isApprox(Vector3d::UnitY()));
  EXPECT_TRUE(pose.linear().col(0).isApprox(Vector3d::UnitX()));
  EXPECT_TRUE(pose.linear().col(1).isApprox(-Vector3d::UnitZ()));
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
}

TEST(CameraPath, ThatIsOpenStartsAndEndsAtItsOuterWaypoints) {
  const CameraPath path({{{0, 0, 1}, {1, 0, 0}}, {{1, 2, 1}, {1, 0, 0}}, {{4, 1, 2}, {0, 1, 0}}},
                        false);
  EXPECT_TRUE(path.pose_at(0).isApprox(look_along({0, 0, 1}, {1, 0, 0}), 1e-12));
  EXPECT_TRUE(path.pose_at(path.end()).isApprox(look_along({4, 1, 2}, {0, 1, 0}), 1e-12));
  EXPECT_TRUE(path.pose_at(path.end() + 5).isApprox(path.pose_at(path.end()), 1e-12));
}

TEST(CameraPath, ThatIsClosedComesBackToItsStart) {
  const CameraPath path = square_path();
  EXPECT_TRUE(path.pose_at(path.end()).isApprox(path.pose_at(0), 1e-12));
  EXPECT_TRUE(path.pose_at(path.end() + 0.3).isApprox(path.pose_at(0.3), 1e-12));
}

TEST(CameraPath, NeverSwingsOutOfItsWaypoints) {
  const CameraPath path = square_path();
  for (double u = 0; u < path.end(); u += 0.01) {
    const Vector3d p = path.pose_at(u).translation();
    EXPECT_TRUE(p.x() >= 0 && p.x() <= 3 && p.y() >= 0 && p.y() <= 3) << p.transpose();
  }
}

TEST(CameraPath, HasNoKinks) {
  const CameraPath path = square_path();
  constexpr double h = 1e-4;
  for (double u = 0; u < path.end(); u += 0.25) {
    const auto velocity = [&](double at) -> Vector3d {
      return (path.pose_at(at + h).translation() - path.pose_at(at).translation()) / h;
    };
    EXPECT_LT((velocity(u) - velocity(u - h)).norm(), 0.01) << u;
  }
}

TEST(CameraPath, NeedsEnoughWaypoints) {
  EXPECT_THROW(CameraPath({{{0, 0, 0}, {1, 0, 0}}}, false), UsageError);
  EXPECT_THROW(CameraPath({{{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}}, true), UsageError);
}

TEST(PlanMotion, KeepsWithinBothLimits) {
  const CameraMotion motion = plan_motion(square_path(), limits, 0, 2, 15, {0, 0.1});
  EXPECT_LE(largest_translation_m(motion.at[0]), limits.max_translation_m);
  double turned_rad = 0;
  for (std::size_t i = 1; i < motion.at[0].size(); ++i) {
    const double rotation_rad = rotation_angle_rad(motion.at[0][i - 1].world_from_camera,
                                                   motion.at[0][i].world_from_camera);
    EXPECT_LE(rotation_rad, limits.max_rotation_rad);
    turned_rad += rotation_rad;
  }
  EXPECT_NEAR(turned_rad, 2 * std::numbers::pi, 0.01) << "once round";
}

TEST(PlanMotion, TakesTheFramesThatTheWholePathNeeds) {
  // 10 m in steps of at most 95 % of 7 cm: 151 frames.
  const CameraMotion motion = plan_motion(straight_path(10), limits, 0, 2, 15, {0, 0});
  EXPECT_NEAR(static_cast<double>(motion.at[0].size()), 10 / (0.95 * 0.07) + 1, 1.0);
  EXPECT_NEAR(motion.at[0].back().world_from_camera.translation().x(), 10, 0.001);
  EXPECT_EQ(plan_motion(straight_path(10), limits, 0, 300, 15, {0, 0}).at[0].size(), 300U);
}

TEST(PlanMotion, SlowsDownForMoreFramesAndStopsEarlyForFewer) {
  const CameraMotion slow = plan_motion(straight_path(1), limits, 101, 2, 15, {0, 0});
  ASSERT_EQ(slow.at[0].size(), 101U);
  EXPECT_NEAR(largest_translation_m(slow.at[0]), 0.01, 1e-4);
  EXPECT_NEAR(slow.at[0].back().world_from_camera.translation().x(), 1, 1e-6);
  const CameraMotion part = plan_motion(straight_path(10), limits, 11, 2, 15, {0, 0});
  ASSERT_EQ(part.at[0].size(), 11U);
  EXPECT_NEAR(part.at[0].back().world_from_camera.translation().x(), 10 * 0.95 * 0.07, 1e-3);
}

TEST(PlanMotion, PutsBBetweenItsFrameAndTheNext) {
  const CameraMotion motion = plan_motion(straight_path(5), limits, 0, 2, 10, {0, 0.25});
  const auto x = [](const StampedPose& pose) { return pose.world_from_camera.translation().x(); };
  const double a = x(motion.at[0][20]);
  const double next = x(motion.at[0][21]);
  EXPECT_NEAR(x(motion.at[1][20]), a + 0.25 * (next - a), 1e-4);
  EXPECT_DOUBLE_EQ(motion.at[0][20].timestamp_s, 2.0);
}

TEST(PlanMotion, GoesOnToTheLastB) {
  for (const double b_delay_share : {0.1, 1.0}) {
    const CameraMotion open = plan_motion(straight_path(5), limits, 0, 2, 10, {0, b_delay_share});
    const auto x = [](const StampedPose& pose) { return pose.world_from_camera.translation().x(); };
    const double step_m = x(open.at[0][20]) - x(open.at[0][19]);
    EXPECT_NEAR(x(open.at[1].back()) - x(open.at[0].back()), b_delay_share * step_m, 1e-3 * step_m);
  }
}

TEST(PlanMotion, StandsStillOnAPathWithoutLength) {
  const CameraMotion motion = plan_motion(straight_path(0), limits, 3, 2, 15, {0, 0.5});
  ASSERT_EQ(motion.at[0].size(), 3U);
  for (const StampedPose& pose : motion.at[1]) {
    EXPECT_TRUE(pose.world_from_camera.isApprox(look_along({0, 0, 1}, {1, 0, 0}), 1e-12));
  }
}

TEST(ReplayMotion, PutsBBetweenPosesAndBeyondTheLast) {
  Trajectory poses;
  for (int i = 0; i < 3; ++i) {
    poses.push_back({1.0 * i, look_along({1.0 * i * i, 0, 0}, Vector3d::UnitX())});
  }
  const CameraMotion motion = replay_motion(poses, 0, {0, 0.5});
  ASSERT_EQ(motion.at[1].size(), 3U);
  EXPECT_NEAR(motion.at[1][0].world_from_camera.translation().x(), 0.5, 1e-12);
  EXPECT_NEAR(motion.at[1][1].world_from_camera.translation().x(), 2.5, 1e-12);
  EXPECT_NEAR(motion.at[1][2].world_from_camera.translation().x(), 5.5, 1e-12);
  EXPECT_EQ(replay_motion(poses, 2, {0, 0.5}).at[0].size(), 2U);
  EXPECT_THROW(replay_motion({}, 0, {0, 0}), UsageError);
}

}  // namespace
}  // namespace tofmap
