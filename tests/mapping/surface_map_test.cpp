// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/surface_map.hpp>

namespace tofmap {
namespace {

SurfacePoint point_at(float z, float sigma_m) {
  SurfacePoint point;
  point.getVector3fMap() = Eigen::Vector3f(0.01F, 0.01F, z);
  point.getNormalVector3fMap() = Eigen::Vector3f(0, 0, -1);
  point.sigma_m = sigma_m;
  point.confidence = 0.8F;
  return point;
}

TEST(SurfaceMap, AveragesAVoxelByTheVarianceOfItsPoints) {
  SurfaceMap map({.voxel_m = 0.1, .min_observations = 1});
  SurfaceCloud cloud;
  cloud.push_back(point_at(1.01F, 0.01F));
  cloud.push_back(point_at(1.06F, 0.02F));
  map.integrate(cloud, Pose::Identity());
  const MapCloud points = map.extract();
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].z, (4 * 1.01 + 1 * 1.06) / 5, 1e-5);  // weights 1 / σ²
  EXPECT_EQ(points[0].observations, 2U);
  EXPECT_NEAR(points[0].confidence, 0.8, 1e-6);
}

TEST(SurfaceMap, BelievesPointsByTheirConfidence) {
  SurfaceMap map({.voxel_m = 0.1, .min_observations = 1});
  SurfaceCloud cloud;
  cloud.push_back(point_at(1.01F, 0.01F));
  cloud.push_back(point_at(1.06F, 0.01F));
  cloud.back().confidence = 0.2F;
  map.integrate(cloud, Pose::Identity());
  EXPECT_NEAR(map.extract()[0].z, (0.8 * 1.01 + 0.2 * 1.06) / 1.0, 1e-5);
}

TEST(SurfaceMap, LeavesOutVoxelsSeenTooSeldomAndPointsTooUncertain) {
  SurfaceMap map({.voxel_m = 0.1, .min_observations = 2, .max_sigma_m = 0.05});
  SurfaceCloud cloud;
  cloud.push_back(point_at(1.01F, 0.01F));
  cloud.push_back(point_at(1.02F, 0.2F));
  map.integrate(cloud, Pose::Identity());
  EXPECT_EQ(map.size(), 1U);
  EXPECT_TRUE(map.extract().empty());
}

TEST(SurfaceMap, GrowsWithTheSurfaceAndNotWithTheFrames) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud cloud = test::box_cloud(camera, {-1, -1, -1}, {1, 1, 3}, Pose::Identity());
  SurfaceMap map({});
  map.integrate(cloud, Pose::Identity());
  const std::size_t once = map.size();
  for (int i = 0; i < 20; ++i) map.integrate(cloud, Pose::Identity());
  EXPECT_EQ(map.size(), once);
}

TEST(SurfaceMap, RefusesVoxelsTooSmallForItsExtent) {
  SurfaceMap map({.voxel_m = 0.002});
  SurfaceCloud cloud;
  cloud.push_back(point_at(5000, 0.01F));
  EXPECT_THROW(map.integrate(cloud, Pose::Identity()), UsageError);
}

TEST(SurfaceMap, AddsAPartWhereItsFrameIs) {
  SurfaceMap part({.voxel_m = 0.1, .min_observations = 1});
  SurfaceCloud cloud;
  cloud.push_back(point_at(1.01F, 0.01F));
  cloud.push_back(point_at(1.06F, 0.02F));
  part.integrate(cloud, Pose::Identity());
  Pose world_from_part = Pose::Identity();
  world_from_part.translation() = Eigen::Vector3d(0, 0, 5);
  SurfaceMap whole({.voxel_m = 0.1, .min_observations = 4});
  whole.add(part, world_from_part);
  EXPECT_TRUE(whole.extract().empty()) << "two observations";
  whole.add(part, world_from_part);
  const MapCloud points = whole.extract();
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].z, 5 + (4 * 1.01 + 1 * 1.06) / 5, 1e-5);
  EXPECT_EQ(points[0].observations, 4U);
  EXPECT_NEAR(points[0].normal_z, -1, 1e-6);
}

}  // namespace
}  // namespace tofmap
