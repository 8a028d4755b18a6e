// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/rotation_search.hpp>

namespace tofmap {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

std::shared_ptr<const SurfaceCloud> seen_from(const Pose& pose) {
  return std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), {-1.5, -1.0, -1}, {2.5, 1.4, 4}, pose));
}

/// Keyframes in the middle of a room, which look in nine directions.
class SearchRotations : public testing::Test {
 protected:
  SearchRotations() {
    for (const double pitch : {-0.5, 0.0, 0.5}) {
      for (const double yaw : {-0.7, 0.0, 0.7}) {
        keyframes_.push_back({.id = static_cast<int>(keyframes_.size()),
                              .world_from_camera = test::moved_by({pitch, yaw, 0}, {0, 0, 0})});
        keyframes_.back().cloud = seen_from(keyframes_.back().world_from_camera);
      }
    }
    for (const Keyframe& keyframe : keyframes_) around_.push_back(&keyframe);
  }

  std::vector<Keyframe> keyframes_;
  std::vector<const Keyframe*> around_;
};

/// The largest error over turns by 30 degrees about axes in all directions.
double worst_error_rad(const std::vector<const Keyframe*>& around, const Eigen::Vector3d& moved_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  double worst_rad = 0;
  for (int i = 0; i < 15; ++i) {
    const Eigen::Vector3d axis(any(random), any(random), any(random));
    const Pose turned = test::moved_by(30 * rad_per_deg * axis.normalized(), moved_m);
    const auto found = search_rotations(*seen_from(turned), around, Pose::Identity(), 0.6, 1);
    if (found.size() != 1) return INFINITY;
    EXPECT_TRUE(found[0].translation().isZero());
    worst_rad = std::max(worst_rad, rotation_angle_rad(found[0], turned));
  }
  return worst_rad;
}

TEST_F(SearchRotations, FindsATurnByThirtyDegreesAboutAnyAxis) {
  // No rotation is farther than half the diagonal of a cell, 3.5 degrees, from the grid; another
  // degree and a half is left to the bins of the panorama.
  EXPECT_LT(worst_error_rad(around_, {0, 0, 0}), 5 * rad_per_deg);
}

TEST_F(SearchRotations, FindsATurnOfACameraThatMovesAsWell) {
  // 28 cm seen at 2 m turn the view by 8 degrees.
  EXPECT_LT(worst_error_rad(around_, {0.2, 0, -0.2}), 8 * rad_per_deg);
}

TEST_F(SearchRotations, ReturnsAtMostTheAskedNumberAndTheyDiffer) {
  const auto found =
      search_rotations(*seen_from(Pose::Identity()), around_, Pose::Identity(), 0.6, 3);
  ASSERT_GE(found.size(), 1U);
  ASSERT_LE(found.size(), 3U);
  EXPECT_LT(rotation_angle_rad(found[0], Pose::Identity()), 1e-9);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GT(rotation_angle_rad(found[0], found[i]), 7.9 * rad_per_deg);
  }
}

TEST_F(SearchRotations, FindsNothingInAnotherRoom) {
  const SurfaceCloud elsewhere =
      test::box_cloud(test::small_camera(), {-0.4, -0.5, -1}, {0.5, 0.4, 0.9}, Pose::Identity());
  EXPECT_TRUE(search_rotations(elsewhere, around_, Pose::Identity(), 0.6, 4).empty());
}

TEST_F(SearchRotations, FindsNothingWithoutPointsOrKeyframes) {
  EXPECT_TRUE(search_rotations({}, around_, Pose::Identity(), 0.6, 4).empty());
  const auto cloud = seen_from(Pose::Identity());
  EXPECT_TRUE(search_rotations(*cloud, {}, Pose::Identity(), 0.6, 4).empty());
}

}  // namespace
}  // namespace tofmap
