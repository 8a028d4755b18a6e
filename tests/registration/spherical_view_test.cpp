// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include <gtest/gtest.h>

#include <tofmap/registration/oriented_cloud.hpp>
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

TEST(Sights, TellSurfacesFromFreeSpaceAndFromWhatIsHidden) {
  const OrientedCloud far = wall_at(4);
  const SphericalView view(far.points_m, Eigen::Vector3d::Zero());
  const auto count = [&](const OrientedCloud& wall, Sight sight) {
    const auto found = sights(view, wall.points_m, Pose::Identity(), 0.1);
    return static_cast<std::size_t>(std::ranges::count(found, sight));
  };
  EXPECT_EQ(count(far, Sight::surface), far.size());
  // The near wall fills a wider angle than the far one: its border is in no bin of the view.
  const OrientedCloud near = wall_at(2);
  EXPECT_GT(count(near, Sight::free_space), near.size() / 5);
  EXPECT_EQ(count(near, Sight::surface), 0U);
  EXPECT_EQ(count(near, Sight::free_space) + count(near, Sight::nothing), near.size());
  const OrientedCloud behind = wall_at(6);
  EXPECT_EQ(count(behind, Sight::nothing), behind.size());
}

}  // namespace
}  // namespace tofmap
