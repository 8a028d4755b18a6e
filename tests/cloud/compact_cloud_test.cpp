// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/compact_cloud.hpp"

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// A noisy corner of a room, with some pixels that have no range and some without normals.
SurfaceCloud corner(const CameraModel& camera, double far_m = 6) {
  RangeImage image =
      test::box_ranges(camera, {-3, -1.5, -3}, {4, 1.5, far_m}, Pose::Identity(), 0.01F);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 0.01F);
  for (float& range : image.range_m.reshaped()) range += noise(random);
  for (int col = 10; col < 20; ++col) image.invalidate(30, col, InvalidReason::no_return);
  SurfaceCloud cloud = surface_cloud(image, pixel_rays(camera), {});
  for (int col = 40; col < 50; ++col) {
    SurfacePoint& point = cloud.at(col, 5);
    point.getNormalVector3fMap().setConstant(nan);
    point.normal_sigma_rad = nan;
    point.confidence = col < 45 ? -1 : 0.25F;
  }
  return cloud;
}

TEST(CompactCloud, DiffersFromTheCloudByNoMoreThanItSays) {
  const CameraModel camera = test::small_camera();
  for (const double far_m : {6.0, 20.0, 60.0}) {
    const SurfaceCloud cloud = corner(camera, far_m);
    const SurfaceCloud again = expand(compact(cloud), pixel_rays(camera));
    ASSERT_EQ(again.width, cloud.width);
    ASSERT_EQ(again.height, cloud.height);
    double farthest_m = 0;
    for (const SurfacePoint& point : cloud.points) {
      if (point.has_position())
        farthest_m = std::max<double>(farthest_m, point.getVector3fMap().norm());
    }
    const double most_m =
        0.000126 * std::exp2(std::max(0.0, std::ceil(std::log2(farthest_m / 16))));
    constexpr float least_number = 6.5e-5F;
    int normals = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const SurfacePoint& before = cloud.points[i];
      const SurfacePoint& after = again.points[i];
      ASSERT_EQ(after.has_position(), before.has_position()) << i;
      ASSERT_EQ(after.has_normal(), before.has_normal()) << i;
      if (!before.has_position()) {
        EXPECT_EQ(after.confidence, 0);
        continue;
      }
      EXPECT_LT((after.getVector3fMap() - before.getVector3fMap()).norm(), most_m) << i;
      EXPECT_NEAR(after.sigma_m / before.sigma_m, 1, 0.032) << i;
      EXPECT_NEAR(after.confidence, before.confidence, 0.0021) << i;
      if (!before.has_normal()) continue;
      ++normals;
      EXPECT_LT((after.getNormalVector3fMap() - before.getNormalVector3fMap()).norm(), 0.001) << i;
      EXPECT_NEAR(after.getNormalVector3fMap().norm(), 1, 1e-6) << i;
      const float limited = std::max(before.normal_sigma_rad, least_number);
      EXPECT_NEAR(after.normal_sigma_rad / limited, 1, 0.032) << i;
    }
    EXPECT_GT(normals, 5000);
  }
}

TEST(CompactCloud, KeepsWhatMovesApart) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud again = expand(compact(corner(camera)), pixel_rays(camera));
  EXPECT_EQ(again.at(40, 5).confidence, -1);
  EXPECT_EQ(again.at(49, 5).confidence, 63.0F / 250);
}

TEST(CompactCloud, TakesASixthOfTheBytesEvenIfNothingCanBeCompressed) {
  const CameraModel camera = test::small_camera();
  SurfaceCloud cloud = corner(camera);
  EXPECT_LT(6 * compact(cloud).bytes.size(), sizeof(SurfacePoint) * cloud.size());
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0, 1);
  const PixelRays rays = pixel_rays(camera);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto p = static_cast<Eigen::Index>(i);
    SurfacePoint& point = cloud.points[i];
    point.getVector3fMap() = 15 * any(random) * Eigen::Vector3f(rays.x(p), rays.y(p), rays.z(p));
    point.getNormalVector3fMap() =
        Eigen::Vector3f(any(random), any(random), -any(random)).normalized();
    point.sigma_m = any(random);
    point.normal_sigma_rad = any(random);
    point.confidence = any(random);
  }
  EXPECT_LT(5.9 * static_cast<double>(compact(cloud).bytes.size()),
            static_cast<double>(sizeof(SurfacePoint) * cloud.size()));
}

TEST(CompactCloud, IsTheSameWhenItIsMadeCompactAgain) {
  const CameraModel camera = test::small_camera();
  const PixelRays rays = pixel_rays(camera);
  const SurfaceCloud once = expand(compact(corner(camera)), rays);
  const SurfaceCloud twice = expand(compact(once), rays);
  for (std::size_t i = 0; i < once.size(); ++i) {
    if (!once.points[i].has_position()) continue;
    EXPECT_EQ(once.points[i].getVector3fMap(), twice.points[i].getVector3fMap());
    EXPECT_EQ(once.points[i].sigma_m, twice.points[i].sigma_m);
    EXPECT_EQ(once.points[i].confidence, twice.points[i].confidence);
  }
}

TEST(CompactCloud, RefusesDamagedBytes) {
  const CameraModel camera = test::small_camera();
  const PixelRays rays = pixel_rays(camera);
  const CompactCloud whole = compact(corner(camera));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, whole.bytes.size() / 2, whole.bytes.size() - 1}) {
    CompactCloud cut = whole;
    cut.bytes.resize(size);
    EXPECT_THROW(expand(cut, rays), InputError) << size;
  }
  int refused = 0;
  for (std::size_t at = 0; at < whole.bytes.size(); at += whole.bytes.size() / 50) {
    CompactCloud flipped = whole;
    flipped.bytes[at] ^= 4;
    try {
      // Where all pixels are alike, a repetition from elsewhere is the same.
      EXPECT_EQ(compact(expand(flipped, rays)).bytes, compact(expand(whole, rays)).bytes) << at;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 40) << "of 50";
  CompactCloud other = whole;
  std::swap(other.width_px, other.height_px);
  EXPECT_THROW(expand(other, rays), InputError);
}

TEST(CompactCloud, RefusesWhatIsNoOrganisedCloud) {
  EXPECT_THROW(compact(SurfaceCloud()), UsageError);
  SurfaceCloud cloud = corner(test::small_camera());
  cloud.at(3, 3).z = 1e6F;
  EXPECT_THROW(compact(cloud), UsageError);
}

}  // namespace
}  // namespace tofmap
