// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {
namespace {

constexpr double pi = std::numbers::pi;

Pose pose(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation_m) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
  pose.translation() = translation_m;
  return pose;
}

class TrajectoryFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }

  /// Expects a complaint that names file and line.
  void expect_refusal(const std::string& text, int line) const {
    try {
      read_trajectory(write(text));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("path.txt:" + std::to_string(line)),
                std::string::npos)
          << error.what();
    }
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "path.txt";
};

TEST_F(TrajectoryFile, ComesBackAsItWasWritten) {
  Trajectory path;
  for (int i = 0; i < 50; ++i) {
    path.push_back({1305031102.175304 + i / 30.0,
                    pose(0.13 * i, {1, 0.1 * i, -2}, {0.1 * i, -7.123456789, 1e-6 * i})});
  }
  write_trajectory(file_, path);
  const Trajectory again = read_trajectory(file_);
  ASSERT_EQ(again.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    // Six decimals of a second, nine of a pose.
    EXPECT_NEAR(again[i].timestamp_s, path[i].timestamp_s, 1e-6);
    EXPECT_TRUE(again[i].world_from_camera.isApprox(path[i].world_from_camera, 1e-8)) << i;
  }
}

TEST_F(TrajectoryFile, IsReadInTheOrderOfTum) {
  // A quarter turn about z, x y z w: takes the camera's x to the world's y.
  const Trajectory path =
      read_trajectory(write("# a comment\n\n  1.5 1 2 3 0 0 0.70710678 0.70710678\r\n"));
  ASSERT_EQ(path.size(), 1U);
  EXPECT_EQ(path[0].timestamp_s, 1.5);
  const Eigen::Vector3d point = path[0].world_from_camera * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((point - Eigen::Vector3d(1, 3, 3)).norm(), 0, 1e-8);
}

TEST_F(TrajectoryFile, MendsQuaternionsOffUnitLength) {
  const Trajectory path = read_trajectory(write("0 0 0 0 0 0 0 0.98\n"));
  EXPECT_TRUE(path[0].world_from_camera.isApprox(Pose::Identity(), 1e-12));
}

TEST_F(TrajectoryFile, WithABadLineIsRefusedWithItsNumber) {
  const std::string good = "0 0 0 0 0 0 0 1\n";
  expect_refusal("# comment\n" + good + "1 0 0 0 0 0 0\n", 3);
  expect_refusal(good + "1 0 0 x 0 0 0 1\n", 2);
  expect_refusal(good + "1 0 0 0 0 0 0 0\n", 2);
  expect_refusal(good + "1 0 nan 0 0 0 0 1\n", 2);
  expect_refusal(good + "1 0 0 0 0 0 0 1 5\n", 2);
}

TEST_F(TrajectoryFile, IsReadWithoutItsBadLines) {
  const UsableTrajectory usable = read_usable_trajectory(
      write("0 1 2 3 0 0 0 1\nno pose\n1 1e39 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n3 0 0 0 0 0 0 0\n"
            "4 5000000 5000000 0 0 0 0 1\n"));
  ASSERT_EQ(usable.poses.size(), 2U);
  EXPECT_EQ(usable.poses[1].timestamp_s, 4);
  ASSERT_EQ(usable.damages.size(), 4U);
  EXPECT_NE(usable.damages[0].find(":2: expected"), std::string::npos) << usable.damages[0];
  EXPECT_NE(usable.damages[3].find(":5: expected"), std::string::npos) << usable.damages[3];
  EXPECT_THROW(read_usable_trajectory(folder_.path() / "none.txt"), InputError);
}

TEST_F(TrajectoryFile, ThatIsMissingIsNamed) {
  EXPECT_THROW(read_trajectory(folder_.path() / "none.txt"), InputError);
}

TEST(TrajectoryWriting, OntoAFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  EXPECT_THROW(write_trajectory("/dev/full", {{0, Pose::Identity()}}), InputError);
}

TEST(RotationAngle, IsThatBetweenTheTwo) {
  const Pose a = pose(0.4, {0, 0, 1}, {1, 2, 3});
  EXPECT_NEAR(rotation_angle_rad(a, pose(1.1, {0, 0, 1}, {9, 9, 9})), 0.7, 1e-12);
  EXPECT_NEAR(rotation_angle_rad(a, a), 0, 1e-12);
  EXPECT_NEAR(rotation_angle_rad(Pose::Identity(), pose(1.5 * pi, {1, 1, 0}, {0, 0, 0})), pi / 2,
              1e-12)
      << "the shorter way round";
}

TEST(PoseFromTwist, RotatesByTheVectorAndThenMoves) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0, 0, pi / 2, 1, 2, 3;
  const Eigen::Vector3d point = pose_from_twist(twist) * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((point - Eigen::Vector3d(1, 3, 3)).norm(), 0, 1e-12);
  EXPECT_TRUE(pose_from_twist(twist * 0).isApprox(Pose::Identity(), 0));
}

TEST(PoseFromTwist, IsItsFirstOrderModelForSmallTwists) {
  // The registration linearises p + ω × p + t; what is left is of second order.
  Eigen::Matrix<double, 6, 1> twist;
  twist << 1, -2, 0.5, 3, 1, -1;
  twist *= 1e-5;
  const Eigen::Vector3d p(1, -2, 4);
  const Eigen::Vector3d model = p + twist.head<3>().cross(p) + twist.tail<3>();
  EXPECT_NEAR((pose_from_twist(twist) * p - model).norm(), 0, 1e-8);
}

TEST(TwistBetween, TakesOnePoseToTheOther) {
  Pose from = Pose::Identity();
  from.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()).toRotationMatrix();
  from.translation() << 1, 2, 3;
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.3, -0.2, 0.1, 4, 5, 6;
  const Pose to = moved_by(twist, from);
  EXPECT_LT((to.translation() - Eigen::Vector3d(5, 7, 9)).norm(), 1e-12);
  EXPECT_LT((twist_between(from, to) - twist).norm(), 1e-12);
  EXPECT_TRUE(twist_between(from, from).isZero(1e-12));
}

TEST(Interpolation, EndsAtBothPosesAndHalvesTheWay) {
  const Pose a = pose(0.2, {0, 1, 0}, {0, 0, 0});
  const Pose b = pose(0.8, {0, 1, 0}, {2, 4, 6});
  EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 0.5).isApprox(pose(0.5, {0, 1, 0}, {1, 2, 3}), 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1.5).isApprox(pose(1.1, {0, 1, 0}, {3, 6, 9}), 1e-12));
}

TEST(Interpolation, TurnsTheShorterWayRound) {
  // From 170° to −170° lie 20°, not 340°.
  const Pose a = pose(170 * pi / 180, {0, 0, 1}, {0, 0, 0});
  const Pose b = pose(-170 * pi / 180, {0, 0, 1}, {0, 0, 0});
  EXPECT_TRUE(interpolate(a, b, 0.5).isApprox(pose(pi, {0, 0, 1}, {0, 0, 0}), 1e-9));
}

TEST(PoseAt, LiesBetweenThePosesBeforeAndAfter) {
  // Half a second apart: a share of the time between them is not a time.
  const Trajectory path{{1.5, pose(0.2, {0, 0, 1}, {4, 0, 0})}, {1, pose(0, {0, 0, 1}, {0, 0, 0})}};
  const auto found = pose_at(path, 1.125, 1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->translation().x(), 1, 1e-12);
  EXPECT_NEAR(rotation_angle_rad(*found, path[1].world_from_camera), 0.05, 1e-12);
  EXPECT_NEAR(pose_at(path, 1, 1)->translation().x(), 0, 1e-12);
}

TEST(PoseAt, IsTheOnlyOneThatIsNear) {
  const Trajectory path{{1, pose(0, {0, 0, 1}, {0, 0, 0})}, {2, pose(0, {0, 0, 1}, {4, 0, 0})}};
  EXPECT_EQ(pose_at(path, 1.1, 0.2)->translation().x(), 0);
  EXPECT_EQ(pose_at(path, 1.9, 0.2)->translation().x(), 4);
  EXPECT_EQ(pose_at(path, 0.9, 0.2)->translation().x(), 0);
  EXPECT_FALSE(pose_at(path, 1.5, 0.2));
  EXPECT_FALSE(pose_at({}, 1.5, 0.2));
}

}  // namespace
}  // namespace tofmap
