// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/exposure_pair.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/camera.hpp>

namespace tofmap {
namespace {

/// Each coefficient is large enough to move the corner of the image by more than a pixel.
CameraModel distorted_camera() {
  return {.width_px = 176,
          .height_px = 144,
          .fx_px = 130,
          .fy_px = 125,
          .cx_px = 88,
          .cy_px = 70,
          .distortion = {0.1, -0.1, 0.03, -0.02, 0.1}};
}

struct Warped {
  float col = 0;
  float row = 0;
  float shrinkage_m = 0;
};

Warped warped(const ExposureMotion& motion, const Eigen::Vector3f& ray, float range_m) {
  Warped out;
  warp(ExposureWarp(distorted_camera(), motion), 1, &ray.x(), &ray.y(), &ray.z(), &range_m,
       &out.col, &out.row, &out.shrinkage_m);
  return out;
}

TEST(ExposureWarp, ProjectsAsTheCameraDoesFromWhereItIsAtB) {
  const CameraModel camera = distorted_camera();
  const ExposureMotion motion{.translation_m = {0.05, -0.04, 0.08},
                              .rotation_rad = {0.02, -0.03, 0.04}};
  for (const auto& [u, v] : {std::pair(10, 8), std::pair(88, 70), std::pair(20, 130),
                             std::pair(165, 12), std::pair(160, 135)}) {
    const Eigen::Vector3d ray = pixel_ray(camera, u, v);
    constexpr double range_m = 3.2;
    const Warped found = warped(motion, ray.cast<float>(), float{range_m});
    const Eigen::Vector3d at_b_m =
        rotation_matrix(motion.rotation_rad).transpose() * (range_m * ray - motion.translation_m);
    const auto pixel = project(camera, at_b_m);
    ASSERT_TRUE(pixel);
    // Floats have a relative precision of 1e-7; distortion and division lose two digits.
    EXPECT_NEAR(found.col, pixel->x(), 2e-3) << u << ", " << v;
    EXPECT_NEAR(found.row, pixel->y(), 2e-3) << u << ", " << v;
    EXPECT_NEAR(found.shrinkage_m, range_m - at_b_m.norm(), 1e-5) << u << ", " << v;
  }
}

TEST(ExposureWarp, IsNowhereBehindTheCamera) {
  const ExposureMotion motion{.translation_m = {0, 0, 2}, .rotation_rad = {0, 0, 0}};
  const Warped found = warped(motion, {0, 0, 1}, 1.5F);
  EXPECT_TRUE(std::isnan(found.col));
  EXPECT_TRUE(std::isnan(found.row));
}

}  // namespace
}  // namespace tofmap
