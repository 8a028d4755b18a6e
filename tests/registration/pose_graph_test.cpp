// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/pose_circle.hpp"

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {
namespace {

using test::along_x;
using test::chain;
using test::circle;
using test::drifted;
using test::edge;
using test::largest_error_m;
using test::loop;
using test::moved_by;

constexpr double kernel_width = 3;

TEST(PoseGraph, SharesTheErrorOfALoopAmongEqualEdges) {
  // Three steps of 1 m, and a loop that says 2.7 m: each of the four gives up a quarter of 0.3 m.
  const std::vector<Pose> start{along_x(0), along_x(1), along_x(2), along_x(3)};
  const std::vector<PoseEdge> edges{edge(0, 1, along_x(1)), edge(1, 2, along_x(1)),
                                    edge(2, 3, along_x(1)), edge(0, 3, along_x(2.7))};
  const PoseGraphResult result = optimise_pose_graph(start, edges, kernel_width);
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(result.poses[1].translation().x(), 0.925, 1e-6);
  EXPECT_NEAR(result.poses[2].translation().x(), 1.85, 1e-6);
  EXPECT_NEAR(result.poses[3].translation().x(), 2.775, 1e-6);
  for (const double deviations : result.edge_mahalanobis) EXPECT_NEAR(deviations, 7.5, 1e-4);
}

TEST(PoseGraph, BelievesWhatIsSurer) {
  // 0.3 m between variances of 4 and 1: four fifths and one fifth of it.
  const std::vector<Pose> start{along_x(0), along_x(1)};
  const std::vector<PoseEdge> edges{edge(0, 1, along_x(1), 0.02), edge(0, 1, along_x(1.3), 0.01)};
  const PoseGraphResult result = optimise_pose_graph(start, edges, kernel_width);
  EXPECT_NEAR(result.poses[1].translation().x(), 1.24, 1e-6);
}

TEST(PoseGraph, FindsExactPosesFromDriftedOnes) {
  const std::vector<Pose> truth = circle(24);
  std::vector<PoseEdge> edges = chain(truth);
  edges.push_back(loop(0, 24, Pose::Identity()));
  const auto start = drifted(edges, moved_by({0, 0, 0.02}, {0.02, 0, 0}));
  ASSERT_GT(largest_error_m({start.begin(), start.begin() + 25}, truth), 0.5);
  const PoseGraphResult result =
      optimise_pose_graph({start.begin(), start.begin() + 25}, edges, kernel_width);
  EXPECT_LT(largest_error_m(result.poses, truth), 1e-5);
  EXPECT_TRUE(result.poses[0].isApprox(start[0])) << "the first pose is held";
}

TEST(PoseGraph, MendsDriftByALoopThatIsManyDeviationsOff) {
  const std::vector<Pose> truth = circle(24);
  std::vector<PoseEdge> edges = chain(truth);
  for (PoseEdge& step : edges) step.from_from_to = step.from_from_to * along_x(0.01);
  const std::vector<Pose> start = drifted(edges, Pose::Identity());
  edges.push_back(loop(0, 24, Pose::Identity(), 0.002));
  edges.push_back(loop(1, 24, truth[1].inverse(), 0.002));
  const PoseGraphResult result = optimise_pose_graph(start, edges, kernel_width);
  const double gap_m = (result.poses[0].inverse() * result.poses[24]).translation().norm();
  EXPECT_LT(gap_m, 0.01);
  EXPECT_LT(result.edge_mahalanobis[24], kernel_width) << "a right loop keeps its say";
}

TEST(PoseGraph, StaysWithinMillimetresInSpiteOfWrongLoops) {
  const std::vector<Pose> truth = circle(24);
  std::vector<PoseEdge> edges = chain(truth);
  edges.push_back(loop(0, 24, Pose::Identity()));
  edges.push_back(loop(1, 23, truth[1].inverse() * truth[23]));
  // Places that only look alike.
  const std::size_t first_wrong = edges.size();
  edges.push_back(loop(2, 14, Pose::Identity(), 0.002));
  edges.push_back(loop(5, 20, along_x(0.3), 0.002));
  edges.push_back(loop(7, 19, moved_by({0, 0.4, 0}, {0, 0, 1}), 0.002));
  const auto start = drifted(chain(truth), moved_by({0, 0, 0.005}, {0.005, 0, 0}));
  ASSERT_GT(largest_error_m(start, truth), 0.1);
  const PoseGraphResult result = optimise_pose_graph(start, edges, kernel_width);
  // Geman-McClure kernels leave outliers a weight of their own, which bends the path this much.
  EXPECT_LT(largest_error_m(result.poses, truth), 2e-3);
  for (std::size_t i = first_wrong; i < edges.size(); ++i) {
    EXPECT_GT(result.edge_mahalanobis[i], 10 * kernel_width);
  }
}

TEST(PoseGraph, DoesNotDependOnWhereTheWorldIs) {
  const std::vector<Pose> truth = circle(12);
  std::vector<PoseEdge> edges = chain(truth);
  edges.push_back(loop(0, 12, along_x(0.05)));
  const Pose elsewhere = moved_by({0.3, -1, 2}, {100, -20, 5});
  std::vector<Pose> moved;
  for (const Pose& pose : truth) moved.push_back(elsewhere * pose);
  const PoseGraphResult here = optimise_pose_graph(truth, edges, kernel_width);
  const PoseGraphResult there = optimise_pose_graph(moved, edges, kernel_width);
  ASSERT_GT(largest_error_m(here.poses, truth), 0.01) << "the loop moves the path";
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose difference = elsewhere * here.poses[i] * there.poses[i].inverse();
    EXPECT_LT(difference.translation().norm(), 1e-4);
    EXPECT_LT(rotation_angle_rad(difference, Pose::Identity()), 1e-6);
  }
}

TEST(PoseGraph, HoldsTheFirstPoseOfEachConnectedPart) {
  // Poses 0, 2 and 4 are connected, and so are 1 and 3.
  const std::vector<Pose> start{along_x(0), along_x(5), along_x(1), along_x(6), along_x(2)};
  const std::vector<PoseEdge> edges{edge(0, 2, along_x(1.5)), edge(2, 4, along_x(1.5)),
                                    edge(1, 3, along_x(2))};
  const std::vector<Pose> poses = optimise_pose_graph(start, edges, kernel_width).poses;
  const std::vector<double> expected_m{0, 5, 1.5, 7, 3};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(poses[i].translation().x(), expected_m[i], 1e-6) << i;
  }
  EXPECT_EQ(poses[1].translation().x(), 5);
}

TEST(PoseGraph, OfNothingIsNothing) {
  EXPECT_TRUE(optimise_pose_graph({}, {}, kernel_width).poses.empty());
  EXPECT_EQ(optimise_pose_graph({along_x(2)}, {}, kernel_width).poses.size(), 1U);
}

TEST(PoseGraph, RefusesEdgesToPosesThatAreNotThere) {
  const std::vector<Pose> poses{along_x(0), along_x(1)};
  for (const auto& [from, to] : {std::pair{0, 2}, {-1, 1}, {1, 1}}) {
    const std::vector<PoseEdge> edges{edge(from, to, along_x(1))};
    EXPECT_THROW(optimise_pose_graph(poses, edges, kernel_width), UsageError);
  }
}

}  // namespace
}  // namespace tofmap
