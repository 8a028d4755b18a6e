// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/motion_uncertainty.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Covariance = MotionUncertainty::Covariance;

constexpr double rotation_sigma = 0.02;
constexpr double translation_sigma = 0.03;

/// Information of a pose that is known within a tenth of a millimetre and of a milliradian.
const Covariance precise = 1e8 * Covariance::Identity();

MotionUncertainty after_blind(int frames, MotionUncertainty uncertainty) {
  for (int i = 0; i < frames; ++i) uncertainty.learn(1, Covariance::Zero());
  return uncertainty;
}

TEST(MotionUncertainty, IsThatOfTheChangeAfterAKnownPose) {
  MotionUncertainty uncertainty(rotation_sigma, translation_sigma);
  EXPECT_TRUE(uncertainty.of_pose().isZero(0));
  // As much unknown motion in each of the frames that were missed.
  uncertainty.learn(3, Covariance::Zero());
  EXPECT_NEAR(uncertainty.of_pose()(0, 0), 9 * rotation_sigma * rotation_sigma, 1e-12);
  EXPECT_NEAR(uncertainty.of_pose()(5, 5), 9 * translation_sigma * translation_sigma, 1e-12);
  EXPECT_TRUE(uncertainty.of_pose().isDiagonal(1e-15));
}

TEST(MotionUncertainty, GrowsAsIfChangesOfVelocityAddUp) {
  // After n frames: the position is off by the sum of k a_k, its variance the sum of k².
  const MotionUncertainty uncertainty = after_blind(10, {rotation_sigma, translation_sigma});
  EXPECT_NEAR(uncertainty.of_pose()(3, 3), 385 * translation_sigma * translation_sigma, 1e-9);
}

TEST(MotionUncertainty, IsThatOfBothWhereSurfacesTellAsMuchAsMotion) {
  MotionUncertainty uncertainty(rotation_sigma, translation_sigma);
  Covariance information = Covariance::Zero();
  information(3, 3) = 1 / (translation_sigma * translation_sigma);
  uncertainty.learn(1, information);
  EXPECT_NEAR(uncertainty.of_pose()(3, 3), translation_sigma * translation_sigma / 2, 1e-12);
}

TEST(MotionUncertainty, GrowsOnlyWhereNothingIsLearnt) {
  MotionUncertainty uncertainty(rotation_sigma, translation_sigma);
  Covariance information = Covariance::Zero();
  information(4, 4) = 1e6;
  for (int i = 0; i < 10; ++i) uncertainty.learn(1, information);
  EXPECT_LT(std::sqrt(uncertainty.of_pose()(4, 4)), 0.001);
  EXPECT_GT(std::sqrt(uncertainty.of_pose()(3, 3)), 10 * translation_sigma);
}

TEST(MotionUncertainty, OfVelocityEndsWithASecondKnownPose) {
  MotionUncertainty uncertainty = after_blind(10, {rotation_sigma, translation_sigma});
  uncertainty.learn(1, precise);
  uncertainty.learn(1, precise);
  uncertainty.learn(1, Covariance::Zero());
  EXPECT_LT(std::sqrt(uncertainty.of_pose()(3, 3)), 1.1 * translation_sigma);
}

TEST(MotionUncertainty, RestartsFromAPlaceWithTheVelocityAsUncertainAsBefore) {
  MotionUncertainty moving = after_blind(10, {rotation_sigma, translation_sigma});
  moving.restart();
  EXPECT_TRUE(moving.of_pose().isZero(0));
  moving.learn(1, Covariance::Zero());
  // Ten changes of velocity before, and one since.
  EXPECT_NEAR(moving.of_pose()(3, 3), 11 * translation_sigma * translation_sigma, 1e-9);
}

TEST(MotionUncertainty, AtTheFirstFrameIsThatOfACameraThatMayMove) {
  MotionUncertainty uncertainty(rotation_sigma, translation_sigma);
  uncertainty.forget_velocity();
  EXPECT_TRUE(uncertainty.of_pose().isZero(0));
  uncertainty.learn(1, Covariance::Zero());
  EXPECT_NEAR(uncertainty.of_pose()(3, 3), (9 + 1) * translation_sigma * translation_sigma, 1e-12);
}

TEST(MotionUncertainty, RestartsFromAPlaceThatIsItselfUncertain) {
  MotionUncertainty moving(rotation_sigma, translation_sigma);
  moving.restart(0.01 * Covariance::Identity());
  EXPECT_EQ(moving.of_pose()(3, 3), 0.01);
  moving.learn(1, Covariance::Zero());
  EXPECT_NEAR(moving.of_pose()(3, 3), 0.01 + translation_sigma * translation_sigma, 1e-12);
}

/// A change of the motion by these values along each axis.
MotionUncertainty::Twist change_by(double rotation_rad, double translation_m) {
  MotionUncertainty::Twist change;
  change << Eigen::Vector3d::Constant(rotation_rad), Eigen::Vector3d::Constant(translation_m);
  return change;
}

TEST(MotionUncertainty, IsSmallerOnceTheMotionProvesSteady) {
  const Covariance exact = Covariance::Zero();
  MotionUncertainty steady(rotation_sigma, translation_sigma);
  // Changes of 3 mm and 2 mrad per axis, over two frames each.
  for (int i = 0; i < 300; ++i) steady.note_change(2 * change_by(0.002, 0.003), exact, 2);
  const MotionUncertainty blind = after_blind(1, steady);
  EXPECT_NEAR(std::sqrt(blind.of_pose()(0, 0)), 2 * 0.002, 1e-5);
  EXPECT_NEAR(std::sqrt(blind.of_pose()(3, 3)), 2 * 0.003, 1e-5);
  EXPECT_NEAR(steady.change_sigmas()[2], 2 * 0.002, 1e-5);
  EXPECT_NEAR(steady.change_sigmas()[5], 2 * 0.003, 1e-5);
  for (int i = 0; i < 300; ++i) steady.note_change(change_by(0, 0), exact, 1);
  EXPECT_NEAR(std::sqrt(after_blind(1, steady).of_pose()(3, 3)), 0.1 * translation_sigma, 1e-5);
  for (int i = 0; i < 300; ++i) steady.note_change(change_by(1, 1), exact, 1);
  EXPECT_NEAR(std::sqrt(after_blind(1, steady).of_pose()(3, 3)), translation_sigma, 1e-5);
}

TEST(MotionUncertainty, LearnsNothingFromDirectionsThatTheSurfacesLeaveOpen) {
  const Eigen::Vector3d open = Eigen::Vector3d(0.6, 0, 0.8);
  Covariance covariance = Covariance::Zero();
  covariance.bottomRightCorner<3, 3>() =
      std::pow(0.11 * translation_sigma, 2) * open * open.transpose();
  MotionUncertainty::Twist change = change_by(0, 0);
  change.tail<3>() = 0.02 * open + 0.003 * Eigen::Vector3d(0.8, 0, -0.6);
  MotionUncertainty steady(rotation_sigma, translation_sigma);
  for (int i = 0; i < 300; ++i) steady.note_change(change, covariance, 1);
  // Half of the two directions that are known has a change, that of 3 mm.
  EXPECT_NEAR(steady.change_sigmas()[3], 2 * 0.003 / std::sqrt(2), 1e-5);
  MotionUncertainty unknown(rotation_sigma, translation_sigma);
  unknown.note_change(change_by(0, 0), Covariance::Identity(), 1);
  EXPECT_EQ(unknown.change_sigmas(), change_by(rotation_sigma, translation_sigma));
}

TEST(MotionUncertainty, RotatesWithTheWorld) {
  MotionUncertainty uncertainty(rotation_sigma, translation_sigma);
  Covariance information = Covariance::Zero();
  information(3, 3) = 1e6;
  uncertainty.learn(1, information);
  const double along_y = uncertainty.of_pose()(4, 4);
  uncertainty.rotate(
      Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()).toRotationMatrix());
  EXPECT_NEAR(uncertainty.of_pose()(3, 3), along_y, 1e-12);
  uncertainty.reset();
  EXPECT_TRUE(uncertainty.of_pose().isZero(0));
}

}  // namespace
}  // namespace tofmap
