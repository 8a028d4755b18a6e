// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

CameraModel plain_camera() {
  return {.width_px = 176,
          .height_px = 144,
          .fx_px = 220,
          .fy_px = 210,
          .cx_px = 88,
          .cy_px = 70,
          .distortion = {}};
}

/// Of the size that Kinect calibrations have.
CameraModel distorted_camera() {
  CameraModel camera = plain_camera();
  camera.distortion = {0.23, -0.78, -0.003, 0.004, 0.92};
  return camera;
}

TEST(PixelRay, AtThePrincipalPointIsTheOpticalAxis) {
  const Eigen::Vector3d ray = pixel_ray(distorted_camera(), 88, 70);
  EXPECT_NEAR((ray - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
}

TEST(PixelRay, PointsRightAndDownWherePixelsDo) {
  // 22 / 220 right and 42 / 210 down of the axis.
  const Eigen::Vector3d ray = pixel_ray(plain_camera(), 110, 112);
  EXPECT_NEAR((ray - Eigen::Vector3d(0.1, 0.2, 1).normalized()).norm(), 0, 1e-12);
}

TEST(Projection, OfAPixelsRayIsThePixel) {
  for (const CameraModel& camera : {plain_camera(), distorted_camera()}) {
    for (int v = 0; v < camera.height_px; v += 11) {
      for (int u = 0; u < camera.width_px; u += 7) {
        const Eigen::Vector3d ray = pixel_ray(camera, u, v);
        EXPECT_NEAR(ray.norm(), 1, 1e-12);
        const auto pixel = project(camera, 7.5 * ray);
        ASSERT_TRUE(pixel) << u << ", " << v;
        // Newton's method ends at 1e-12 of the focal length.
        EXPECT_NEAR((*pixel - Eigen::Vector2d(u, v)).norm(), 0, 1e-9);
      }
    }
  }
}

TEST(Projection, FollowsTheDistortionOfOpenCv) {
  // Worked by hand for x = 0.3, y = −0.2 (r² = 0.13), k1 0.1, k2 0.2, p1 0.01, p2 0.02, k3 0.3:
  // radial = 1 + 0.013 + 0.00338 + 0.0006591 = 1.0170391,
  // x' = 0.3 radial + 2 p1 x y + p2 (r² + 2 x²) = 0.30511173 − 0.0012 + 0.0062,
  // y' = −0.2 radial + p1 (r² + 2 y²) + 2 p2 x y = −0.20340782 + 0.0021 − 0.0024.
  CameraModel camera = plain_camera();
  camera.distortion = {0.1, 0.2, 0.01, 0.02, 0.3};
  const auto pixel = project(camera, {0.6, -0.4, 2});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 220 * 0.31011173 + 88, 1e-9);
  EXPECT_NEAR(pixel->y(), 210 * -0.20370782 + 70, 1e-9);
}

/// Distortion coefficients one by one: in cameras that have all of them, the terms of one can hide
/// those of another.
class DistortionTerm : public testing::TestWithParam<std::size_t> {};

TEST_P(DistortionTerm, IsUndoneOverTheWholeImage) {
  CameraModel camera = plain_camera();
  camera.distortion[GetParam()] = GetParam() == 2 || GetParam() == 3 ? 0.05 : 0.2;
  for (int v = 0; v < camera.height_px; v += 13) {
    for (int u = 0; u < camera.width_px; u += 7) {
      const Eigen::Vector3d ray = pixel_ray(camera, u, v);
      ASSERT_TRUE(ray.allFinite()) << u << ", " << v;
      const auto pixel = project(camera, ray);
      ASSERT_TRUE(pixel) << u << ", " << v;
      EXPECT_NEAR((*pixel - Eigen::Vector2d(u, v)).norm(), 0, 1e-9) << u << ", " << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, DistortionTerm, testing::Range(std::size_t{0}, std::size_t{5}));

TEST(Projection, IsEmptyForPointsNotInFrontOfTheCamera) {
  EXPECT_FALSE(project(plain_camera(), {0, 0, 0}));
  EXPECT_FALSE(project(plain_camera(), {1, 1, -2}));
  EXPECT_FALSE(project(plain_camera(), {0, 0, std::numeric_limits<double>::quiet_NaN()}));
}

TEST(Projection, IsEmptyPastTheFoldOfTheDistortion) {
  CameraModel camera = plain_camera();
  camera.distortion = {-0.5, 0, 0, 0, 0};
  // x (1 − x² / 2) turns back at x = sqrt(2/3) = 0.816.
  EXPECT_TRUE(project(camera, {0.8, 0, 1}));
  EXPECT_FALSE(project(camera, {0.83, 0, 1}));
}

TEST(PixelRay, IsNanWhereDistortionHasNoInverse) {
  CameraModel camera = plain_camera();
  camera.distortion = {-0.5, 0, 0, 0, 0};
  // The largest image of the axis y = 0 is 0.816 · 2/3 = 0.544 off the centre.
  EXPECT_TRUE(pixel_ray(camera, 88 + 0.54 * 220, 70).allFinite());
  EXPECT_TRUE(pixel_ray(camera, 88 + 0.55 * 220, 70).hasNaN());
}

TEST(CameraValidation, RefusesADistortionThatFoldsTheImage) {
  CameraModel camera = plain_camera();
  camera.distortion = {-3, 0, 0, 0, 0};
  EXPECT_THROW(validate(camera), InputError);
  EXPECT_NO_THROW(validate(distorted_camera()));
}

TEST(CameraValidation, RefusesWhatIsNoCamera) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = [](auto&& change) {
    CameraModel camera = plain_camera();
    change(camera);
    return camera;
  };
  EXPECT_THROW(validate(broken([](auto& c) { c.width_px = 0; })), InputError);
  EXPECT_THROW(validate(broken([](auto& c) { c.height_px = -1; })), InputError);
  EXPECT_THROW(validate(broken([](auto& c) { c.fx_px = 0; })), InputError);
  EXPECT_THROW(validate(broken([&](auto& c) { c.fy_px = nan; })), InputError);
  EXPECT_THROW(validate(broken([&](auto& c) { c.cx_px = nan; })), InputError);
  EXPECT_THROW(validate(broken([&](auto& c) { c.distortion[4] = nan; })), InputError);
  EXPECT_NO_THROW(validate(plain_camera()));
}

TEST(CameraValidation, RefusesOneFocalLengthThatIsNoNumber) {
  for (double CameraModel::*focal_px : {&CameraModel::fx_px, &CameraModel::fy_px}) {
    CameraModel camera = plain_camera();
    camera.*focal_px = std::numeric_limits<double>::infinity();
    EXPECT_THROW(validate(camera), InputError);
  }
}

TEST(CameraValidation, TakesAPrincipalPointWithinTwentyImagesOfTheMiddle) {
  CameraModel camera = plain_camera();
  const double middle_px = camera.width_px / 2.0;
  for (const double sign : {-1.0, 1.0}) {
    camera.cx_px = middle_px + sign * 19.9 * camera.width_px;
    EXPECT_NO_THROW(validate(camera));
    camera.cx_px = middle_px + sign * 20.1 * camera.width_px;
    EXPECT_THROW(validate(camera), InputError);
  }
}

TEST(PixelRays, AreTheRaysOfSinglePixels) {
  const CameraModel camera = distorted_camera();
  const PixelRays rays = pixel_rays(camera);
  ASSERT_EQ(rays.x.rows(), 144);
  ASSERT_EQ(rays.x.cols(), 176);
  for (int v = 0; v < 144; ++v) {
    for (int u = 0; u < 176; ++u) {
      const Eigen::Vector3d ray = pixel_ray(camera, u, v);
      ASSERT_FLOAT_EQ(rays.x(v, u), static_cast<float>(ray.x())) << u << ", " << v;
      ASSERT_FLOAT_EQ(rays.y(v, u), static_cast<float>(ray.y())) << u << ", " << v;
      ASSERT_FLOAT_EQ(rays.z(v, u), static_cast<float>(ray.z())) << u << ", " << v;
    }
  }
}

TEST(Depth, IsRangeTimesTheCosineOfTheRayAndComesBack) {
  const PixelRays rays = pixel_rays(plain_camera());
  ImageF range_m = ImageF::Constant(144, 176, 5);
  range_m(3, 4) = std::numeric_limits<float>::quiet_NaN();
  const ImageF depth_m = depth_from_range(range_m, rays);
  EXPECT_FLOAT_EQ(depth_m(70, 88), 5);
  // 0.1 right and 0.2 down of the axis: the ray is sqrt(1.05) long at z = 1.
  EXPECT_FLOAT_EQ(depth_m(112, 110), 5 / std::sqrt(1.05F));
  EXPECT_TRUE(std::isnan(depth_m(3, 4)));
  const ImageF again_m = range_from_depth(depth_m, rays);
  EXPECT_FLOAT_EQ(again_m(112, 110), 5);
  EXPECT_TRUE(std::isnan(again_m(3, 4)));
}

}  // namespace
}  // namespace tofmap
