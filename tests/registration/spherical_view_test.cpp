// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {
namespace {

/// A square of points across the z axis, four metres wide.
OrientedCloud wall_at(float z_m) {
  std::vector<Eigen::Vector3f> points;
  for (int i = -40; i <= 40; ++i) {
    for (int j = -40; j <= 40; ++j) {
      points.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(j), z_m);
    }
  }
  const std::vector<Eigen::Vector3f> normals(points.size(), -Eigen::Vector3f::UnitZ());
  const PointSearch search(points);
  return {points, normals, 0.05, search};
}

TEST(SphericalView, KnowsTheNearestRangeInADirection) {
  const OrientedCloud wall = wall_at(3);
  const SphericalView view(wall.points_m, Eigen::Vector3d(0, 0, 1));
  EXPECT_NEAR(view.range_m({0, 0, 7}).value(), 2, 0.01);
  EXPECT_FALSE(view.range_m({0, 0, -7}));
  EXPECT_FALSE(view.nearest_range_around_m({5, 0, 1}));
}

TEST(FreeSpaceViolationShare, IsOfWhatStandsBeforeWhatWasSeen) {
  const OrientedCloud far = wall_at(4);
  const SphericalView view(far.points_m, Eigen::Vector3d::Zero());
  const OrientedCloud near = wall_at(2);
  EXPECT_EQ(free_space_violation_share(view, far, Pose::Identity(), 0.1), 0);
  // The near wall fills a wider angle: what is off the far one was never looked at.
  EXPECT_EQ(free_space_violation_share(view, near, Pose::Identity(), 0.1), 1);
  // Behind it nothing contradicts.
  EXPECT_EQ(free_space_violation_share(view, wall_at(6), Pose::Identity(), 0.1), 0);
}

TEST(MayBeViewpoint, IsAPlaceThatSeesEverything) {
  OrientedCloud walls = wall_at(2);
  const OrientedCloud behind = wall_at(4);
  walls.points_m.insert(walls.points_m.end(), behind.points_m.begin(), behind.points_m.end());
  EXPECT_TRUE(may_be_viewpoint(behind.points_m, Eigen::Vector3d::Zero()));
  EXPECT_FALSE(may_be_viewpoint(walls.points_m, Eigen::Vector3d::Zero()));
  EXPECT_TRUE(may_be_viewpoint(walls.points_m, Eigen::Vector3d(0, 0, 3)));
}

}  // namespace
}  // namespace tofmap
