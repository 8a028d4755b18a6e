// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The covariance of an edge between keyframes against the errors of registrations that it is made
// from.

#include "support/box_ranges.hpp"
#include "support/consistency.hpp"

#include <random>

#include <gtest/gtest.h>

#include <tofmap/mapping/keyframe_edge.hpp>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A covariance of pose errors whose axes are neither the world's nor a camera's: millimetres and
/// milliradians along some, ten times as much along others.
Matrix6d lengthy_covariance() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Matrix6d mixed = Matrix6d::NullaryExpr([&] { return normal(random); });
  Vector6d sigmas;
  sigmas << 1e-3, 1e-2, 2e-3, 1e-3, 1e-2, 3e-3;
  const Matrix6d axes = mixed.householderQr().householderQ();
  return axes * sigmas.cwiseAbs2().asDiagonal() * axes.transpose();
}

/// The pose with the error of a registration: a rotation about the camera's centre and a
/// translation, both along the axes of the world.
Pose with_error(const Pose& world_from_camera, const Vector6d& twist) {
  Pose pose = world_from_camera;
  pose.linear() = pose_from_twist(twist).linear() * world_from_camera.linear();
  pose.translation() += twist.tail<3>();
  return pose;
}

TEST(KeyframeEdge, HasTheCovarianceOfTheRegistrationThatItIsFrom) {
  const Pose world_from_a = test::moved_by({0.4, -1.1, 2}, {3, -2, 1});
  const Pose world_from_b = test::moved_by({0.1, -0.8, 2.2}, {3.5, -2.2, 1.3});
  const std::vector<Pose> truth{world_from_a, world_from_b};
  const Keyframe from{0, 0, 0, world_from_a, {}};
  const Matrix6d covariance = lengthy_covariance();
  const Matrix6d root = covariance.llt().matrixL();
  // What all frames err by in common is added to it.
  const PoseEdge of_nothing = edge_of(from, 1, world_from_b, Matrix6d::Zero());
  const Vector6d shared_sigmas = of_nothing.covariance.diagonal().cwiseSqrt();
  // Half a milliradian and two millimetres, along every axis.
  EXPECT_NEAR((shared_sigmas.head<3>() - Eigen::Vector3d::Constant(5e-4)).norm(), 0, 1e-12);
  EXPECT_NEAR((shared_sigmas.tail<3>() - Eigen::Vector3d::Constant(2e-3)).norm(), 0, 1e-12);

  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto six = [&] { return Vector6d(Vector6d::NullaryExpr([&] { return normal(random); })); };
  test::Consistency consistency;
  for (int draw = 0; draw < 500; ++draw) {
    const Vector6d error = root * six() + shared_sigmas.cwiseProduct(six());
    const PoseEdge edge = edge_of(from, 1, with_error(world_from_b, error), covariance);
    consistency.add_distance(mahalanobis_distance(edge, truth), 6);
  }
  EXPECT_GT(consistency.mean_nees(), consistency.lower_bound());
  EXPECT_LT(consistency.mean_nees(), consistency.upper_bound());
}

}  // namespace
}  // namespace tofmap
