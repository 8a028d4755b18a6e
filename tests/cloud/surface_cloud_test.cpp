// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <random>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

TEST(SurfaceCloud, LiesOnASlantedPlaneWithItsNormal) {
  const CameraModel camera = test::small_camera();
  // The floor of a box, 1 m below: seen at up to 75° of incidence.
  const Vector3d min(-50, -50, -50);
  const Vector3d max(50, 1, 50);
  const RangeImage image = test::box_ranges(camera, min, max, Pose::Identity());
  const SurfaceCloud cloud = surface_cloud(image, pixel_rays(camera), {});
  int checked = 0;
  for (int v = 45; v < 72; ++v) {
    for (int u = 0; u < 88; ++u) {
      const SurfacePoint& point = cloud.at(u, v);
      ASSERT_TRUE(point.has_normal()) << u << ", " << v;
      EXPECT_NEAR(point.y, 1, 1e-4);
      EXPECT_NEAR(point.normal_y, -1, 1e-4);  // towards the camera: up, against y
      ++checked;
    }
  }
  EXPECT_EQ(checked, 27 * 88);
}

TEST(SurfaceCloud, HasLessNoiseThanItsRangesAndPredictsIt) {
  const CameraModel camera = test::small_camera();
  constexpr float sigma = 0.02F;
  RangeImage image =
      test::box_ranges(camera, {-50, -50, -50}, {50, 50, 4}, Pose::Identity(), sigma);
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, sigma);
  for (float& range : image.range_m.reshaped()) range += noise(random);
  const SurfaceCloud cloud = surface_cloud(image, pixel_rays(camera), {});
  double error2 = 0;
  double predicted2 = 0;
  int count = 0;
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_normal()) continue;
    const double along_ray = (point.z - 4) * point.getVector3fMap().norm() / point.z;
    error2 += along_ray * along_ray;
    predicted2 += point.sigma_m * point.sigma_m;
    ++count;
  }
  EXPECT_GT(count, 88 * 72 * 0.9);
  const double error = std::sqrt(error2 / count);
  // 49 pixels with a slope cost a factor of √49 at the image's middle, less at its borders.
  EXPECT_LT(error, sigma / 4);
  EXPECT_NEAR(std::sqrt(predicted2 / count) / error, 1, 0.25);
}

TEST(SurfaceCloud, DoesNotAverageSystematicErrors) {
  const CameraModel camera = test::small_camera();
  RangeImage image =
      test::box_ranges(camera, {-50, -50, -50}, {50, 50, 4}, Pose::Identity(), 0.001F);
  image.systematic_m = 0.01;
  const SurfaceCloud cloud = surface_cloud(image, pixel_rays(camera), {});
  for (const SurfacePoint& point : cloud.points) {
    // Noise and what is systematic of 49 pixels add little: 0.0101² / 49, a slope aside.
    ASSERT_GE(point.sigma_m, 0.01F);
    ASSERT_LT(point.sigma_m, 0.012F);
  }
}

TEST(SurfaceCloud, DoesNotMixTheSidesOfAnEdge) {
  const CameraModel camera = test::small_camera();
  RangeImage near = test::box_ranges(camera, {-50, -50, -50}, {50, 50, 2}, Pose::Identity());
  const RangeImage far = test::box_ranges(camera, {-50, -50, -50}, {50, 50, 3}, Pose::Identity());
  near.range_m.rightCols(44) = far.range_m.rightCols(44);
  const SurfaceCloud cloud = surface_cloud(near, pixel_rays(camera), {});
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_normal()) continue;
    EXPECT_LT(std::min(std::abs(point.z - 2), std::abs(point.z - 3)), 1e-3);
  }
}

TEST(SurfaceCloud, KeepsInvalidPixelsInvalid) {
  const CameraModel camera = test::small_camera();
  RangeImage image = test::box_ranges(camera, {-1, -1, -1}, {1, 1, 3}, Pose::Identity());
  image.invalidate(10, 20, InvalidReason::no_return);
  const SurfaceCloud cloud = surface_cloud(image, pixel_rays(camera), {});
  EXPECT_FALSE(cloud.at(20, 10).has_position());
  EXPECT_FALSE(cloud.at(20, 10).has_normal());
}

TEST(SurfaceCloud, RefusesAnImageOfAnotherSize) {
  const PixelRays rays = pixel_rays(test::small_camera());
  EXPECT_THROW(surface_cloud(RangeImage(10, 10), rays, {}), UsageError);
}

}  // namespace
}  // namespace tofmap
