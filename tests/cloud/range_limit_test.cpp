// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/cloud/range_limit.hpp>

namespace tofmap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Directions of a scanner that turns about its vertical axis, within an interval of elevations.
Points directions(double lowest_rad, double highest_rad) {
  constexpr double step_rad = 0.02;
  Points out;
  for (double elevation = lowest_rad; elevation < highest_rad; elevation += step_rad) {
    for (double azimuth = 0; azimuth < 2 * std::numbers::pi; azimuth += step_rad) {
      out.emplace_back(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    }
  }
  return out;
}

/// Where rays from the origin meet the walls of a box, with a noise of 5 mm.
Points box_seen(const Points& rays, const Eigen::Vector3d& half) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.005);
  Points out;
  for (const Eigen::Vector3d& ray : rays) {
    const double range = 1 / ray.cwiseAbs().cwiseQuotient(half).maxCoeff();
    out.push_back((range + noise(random)) * ray);
  }
  return out;
}

/// A room whose ceiling returns nothing: its upper rays end at a limit of range.
Points room_with_limit(double limit) {
  Points points = box_seen(directions(-1.2, 0.6), {3, 2, 1.5});
  for (const Eigen::Vector3d& ray : directions(0.6, 1.2)) points.push_back(limit * ray);
  return points;
}

Points moved(Points points, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& point : points) point += by;
  return points;
}

TEST(RangeLimit, IsFoundAboutAKnownSensor) {
  const Points points = room_with_limit(30);
  const auto limit = find_range_limit(points, Eigen::Vector3d::Zero());
  ASSERT_TRUE(limit);
  EXPECT_NEAR(limit->range, 30, 1e-6);
  EXPECT_EQ(limit->points, directions(0.6, 1.2).size());
}

TEST(RangeLimit, IsFoundAboutAnUnknownSensor) {
  const Eigen::Vector3d sensor(-7, 4, 12);
  const auto limit = find_range_limit(moved(room_with_limit(30), sensor));
  ASSERT_TRUE(limit);
  EXPECT_LT((limit->sensor - sensor).norm(), 0.01);
  EXPECT_NEAR(limit->range, 30, 0.01);
}

TEST(RangeLimit, IsNotFoundAboutAWrongSensor) {
  EXPECT_FALSE(find_range_limit(room_with_limit(30), Eigen::Vector3d(1, 0, 0)));
}

TEST(RangeLimit, IsFoundAmongPositionsThatAreRoundedToCentimetres) {
  Points points = room_with_limit(30);
  for (Eigen::Vector3d& point : points) point = (100 * point).array().round() / 100;
  EXPECT_TRUE(find_range_limit(points, Eigen::Vector3d::Zero()));
}

TEST(RangeLimit, IsNotTheEndOfARoomOrOfACorridor) {
  const Points rays = directions(-1.2, 1.2);
  for (const Eigen::Vector3d& half : {Eigen::Vector3d(3, 2, 1.5), Eigen::Vector3d(20, 1, 1.2)}) {
    const Points points = box_seen(rays, half);
    EXPECT_FALSE(find_range_limit(points, Eigen::Vector3d::Zero())) << half.transpose();
    EXPECT_FALSE(find_range_limit(points)) << half.transpose();
  }
}

TEST(RangeLimit, IsNotAFarWallThatAlmostFacesTheSensor) {
  // Only the far wall of a corridor: its ranges differ by 0.1 %, as those of a limit may.
  Points points = box_seen(directions(-1.2, -0.3), {3, 2, 1.5});
  for (double y = -0.8; y < 0.8; y += 0.02) {
    for (double z = -0.8; z < 0.8; z += 0.02) points.emplace_back(30, y, z);
  }
  EXPECT_FALSE(find_range_limit(points, Eigen::Vector3d::Zero()));
}

TEST(RangeLimit, IsNotAWallThatFitsALargeSphere) {
  // A wall that bends by 9 cm lies on a sphere of 75 m about a place outside of the room.
  const Eigen::Vector3d far_place(-71, 0, 0);
  Points points = box_seen(directions(-1.2, 0.2), {3, 2, 1.5});
  for (double y = -3; y < 3; y += 0.02) {
    for (double z = 0; z < 2; z += 0.02) {
      points.emplace_back(far_place.x() + std::sqrt(75 * 75 - y * y - z * z), y, z);
    }
  }
  EXPECT_TRUE(find_range_limit(points, far_place));
  EXPECT_FALSE(find_range_limit(points));
}

TEST(RangeLimit, IsNotFoundInAFewPoints) {
  EXPECT_FALSE(find_range_limit(Points{}));
  EXPECT_FALSE(find_range_limit(Points(20, Eigen::Vector3d(30, 0, 0))));
}

TEST(RangeLimit, MayBeAllThatACloudHas) {
  Points points;
  for (const Eigen::Vector3d& ray : directions(-1, 1)) points.push_back(30 * ray);
  const auto limit = find_range_limit(points);
  ASSERT_TRUE(limit);
  EXPECT_EQ(remove_range_limit(points, *limit), limit->points);
  EXPECT_TRUE(points.empty());
}

TEST(RangeLimit, IsRemovedAndLeavesTheSurfaces) {
  Points points = room_with_limit(30);
  const auto limit = find_range_limit(points, Eigen::Vector3d::Zero());
  ASSERT_TRUE(limit);
  EXPECT_EQ(remove_range_limit(points, *limit), limit->points);
  EXPECT_EQ(points, box_seen(directions(-1.2, 0.6), {3, 2, 1.5}));
}

}  // namespace
}  // namespace tofmap
