// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/pose_circle.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/registration/path_uncertainty.hpp>

namespace tofmap {
namespace {

using test::along_x;
using test::chain;
using test::circle;
using test::edge;
using test::loop;

/// Positions as columns.
Eigen::Matrix3Xd positions_of(const std::vector<Pose>& poses) {
  Eigen::Matrix3Xd positions(3, poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = poses[i].translation();
  }
  return positions;
}

/// Poses along a chain of edges, each with an error that has the covariance of the edge.
std::vector<Pose> noisy_path(const std::vector<PoseEdge>& edges, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<Pose> poses{Pose::Identity()};
  for (const PoseEdge& step : edges) {
    const Eigen::Matrix<double, 6, 6> root = step.covariance.llt().matrixL();
    const Eigen::Matrix<double, 6, 1> error =
        root * Eigen::Matrix<double, 6, 1>::NullaryExpr([&] { return normal(random); });
    Pose motion = step.from_from_to;
    motion.linear() = pose_from_twist(error).linear() * motion.linear();
    motion.translation() += error.tail<3>();
    poses.push_back(poses.back() * motion);
  }
  return poses;
}

TEST(PathUncertainty, OfTwoPosesIsHalfOfThatOfTheirDistanceEach) {
  // The alignment leaves nothing of the other errors, but the error of the distance.
  const std::vector<Pose> poses{along_x(0), along_x(2)};
  const std::vector<PoseEdge> edges{edge(0, 1, along_x(2), 0.01)};
  for (const ExpectedError& error : expected_errors(poses, edges)) {
    EXPECT_NEAR(error.position_m, 0.005, 0.0005);
  }
}

TEST(PathUncertainty, IsTheErrorOfManyPathsWithSuchEdges) {
  const std::vector<Pose> truth = circle(24);
  std::vector<PoseEdge> edges = chain(truth);
  for (PoseEdge& step : edges) {  // mostly along one axis, and more in rotation
    step.covariance.diagonal() << 4e-5, 1e-6, 9e-5, 1e-4, 1e-6, 1e-6;
  }
  const Eigen::Matrix3Xd true_positions = positions_of(truth);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(true_positions.cols());
  constexpr int paths = 1000;
  std::mt19937 random(1);
  for (int i = 0; i < paths; ++i) {
    const Eigen::Matrix3Xd positions = positions_of(noisy_path(edges, random));
    const Eigen::Matrix4d alignment = Eigen::umeyama(positions, true_positions, false);
    squares += ((alignment.topLeftCorner<3, 3>() * positions).colwise() +
                alignment.topRightCorner<3, 1>() - true_positions)
                   .colwise()
                   .squaredNorm()
                   .transpose() /
               paths;
  }
  const std::vector<ExpectedError> expected = expected_errors(truth, edges);
  ASSERT_EQ(expected.size(), truth.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double found_m = std::sqrt(squares[static_cast<Eigen::Index>(i)]);
    // 1000 paths and 256 random errors tell a standard deviation to about 5 % together.
    EXPECT_NEAR(expected[i].position_m, found_m, 0.15 * found_m) << i;
  }
}

TEST(PathUncertainty, IsReducedByALoop) {
  const std::vector<Pose> truth = circle(24);
  std::vector<PoseEdge> edges = chain(truth);
  const std::vector<ExpectedError> before = expected_errors(truth, edges);
  edges.push_back(loop(0, 24, Pose::Identity()));
  const std::vector<ExpectedError> after = expected_errors(truth, edges);
  EXPECT_LT(after.back().position_m, 0.7 * before.back().position_m);
  EXPECT_LT(after.back().rotation_rad, before.back().rotation_rad);
  EXPECT_GT(after.back().position_m, 0.01) << "more than the error of the loop";
}

TEST(PathUncertainty, IsLargeWhereNothingConnectsPoses) {
  const std::vector<Pose> poses = circle(8);
  std::vector<PoseEdge> edges = chain(poses);
  edges.pop_back();
  EXPECT_GT(expected_errors(poses, edges).back().position_m, 10);
  edges.pop_back();
  edges.push_back(edge(7, 8, poses[7].inverse() * poses[8]));
  EXPECT_GT(expected_errors(poses, edges).back().position_m, 10) << "an island of two";
}

TEST(PathUncertainty, OfOnePoseOrNoneIsNothing) {
  EXPECT_TRUE(expected_errors({}, {}).empty());
  const std::vector<Pose> one{Pose::Identity()};
  EXPECT_EQ(expected_errors(one, {}).front().position_m, 0);
}

TEST(PathUncertainty, BesidePosesThatAreExactIsThatOfManyPaths) {
  std::vector<Pose> truth = circle(12);
  const Pose origin_from_world = truth.front().inverse();  // where noisy_path() begins
  for (Pose& pose : truth) pose = origin_from_world * pose;
  std::vector<PoseEdge> edges = chain(truth);
  for (PoseEdge& step : edges) step.covariance.diagonal() << 4e-5, 1e-6, 9e-5, 1e-4, 1e-6, 1e-6;
  const std::size_t last = truth.size() - 1;
  Eigen::Matrix<double, 6, 6> found = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int paths = 4000;
  std::mt19937 random(2);
  for (int i = 0; i < paths; ++i) {
    const std::vector<Pose> path = noisy_path(edges, random);
    Eigen::Matrix<double, 6, 1> error;
    const Eigen::AngleAxisd turned(path[last].linear() * truth[last].linear().transpose());
    error << turned.angle() * turned.axis(), path[last].translation() - truth[last].translation();
    found += error * error.transpose() / paths;
  }
  const auto covariances = covariances_beside(truth, edges, 1);
  ASSERT_EQ(covariances.size(), truth.size() - 1);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(covariances.back()(i, i), found(i, i), 0.15 * found(i, i)) << i;
  }
}

TEST(PathUncertainty, BesideTwoExactPosesIsLessThanBesideOne) {
  const std::vector<Pose> poses{along_x(0), along_x(2), along_x(1)};
  std::vector<PoseEdge> edges{edge(0, 2, along_x(1), 0.01)};
  const double beside_one = covariances_beside(poses, edges, 2).front()(3, 3);
  edges.push_back(edge(1, 2, along_x(-1), 0.01));
  EXPECT_NEAR(covariances_beside(poses, edges, 2).front()(3, 3), beside_one / 2, 0.01 * beside_one);
  EXPECT_TRUE(covariances_beside(poses, edges, 3).empty());
}

TEST(PathUncertainty, RefusesEdgesToPosesThatDoNotExist) {
  const std::vector<Pose> poses{along_x(0), along_x(1)};
  const std::vector<PoseEdge> edges{edge(0, 2, along_x(1))};
  EXPECT_THROW(expected_errors(poses, edges), UsageError);
}

}  // namespace
}  // namespace tofmap
