// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/acquisition/kinect2/light_source.hpp>
#include <tofmap/acquisition/kinect2/mirror.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

const Eigen::Vector3d source_m{light_source_x_m, 0, 0};

/// Half of the way from the source to a point and on to the lens, by the lengths of its two parts.
double half_way(const Eigen::Vector3d& point_m, const Eigen::Vector3d& from_m) {
  return ((point_m - from_m).norm() + point_m.norm()) / 2;
}

TEST(Kinect2LightSource, GivesTheRangeOfAPointFromThePathThatTheLightTakes) {
  for (const Eigen::Vector3d& from_m :
       {source_m, Eigen::Vector3d(-0.045, 0, 0), Eigen::Vector3d(0.01, -0.07, 0.02)}) {
    for (const double x : {-2.0, -0.1, 0.0, 0.4, 3.0}) {
      for (const double z : {0.3, 1.0, 12.0}) {
        const Eigen::Vector3d point_m(x, 0.2 * x - 0.1, z);
        const double range_m =
            range_from_half_path(half_way(point_m, from_m), point_m.normalized(), from_m);
        EXPECT_NEAR(range_m, point_m.norm(), 1e-12);
      }
    }
  }
}

TEST(Kinect2LightSource, GivesThePathOfARangeAndTheRangeBack) {
  const Eigen::Vector3d ray = Eigen::Vector3d(0.5, -0.3, 1).normalized();
  for (const double range_m : {0.05, 0.5, 4.0, 18.0}) {
    const double half_path_m = half_path_from_range(range_m, ray, source_m);
    EXPECT_DOUBLE_EQ(half_path_m, half_way(range_m * ray, source_m));
    EXPECT_NEAR(range_from_half_path(half_path_m, ray, source_m), range_m, 1e-12);
  }
}

TEST(Kinect2LightSource, InTheLensMakesNoDifference) {
  const Eigen::Vector3d ray = Eigen::Vector3d(0.2, 0.1, 1).normalized();
  EXPECT_DOUBLE_EQ(range_from_half_path(3.2, ray, Eigen::Vector3d::Zero()), 3.2);
  EXPECT_DOUBLE_EQ(half_path_from_range(3.2, ray, Eigen::Vector3d::Zero()), 3.2);
}

TEST(Kinect2LightSource, AgreesWithLibfreenect2ToHalfAMillimetreBeyondOneMetre) {
  for (const double x : {-0.7, 0.0, 0.6}) {
    for (const double y : {-0.5, 0.2}) {
      const double slant = std::sqrt(x * x + y * y + 1);
      for (const double half_path_m : {1.1, 2.0, 4.5}) {
        const double path_mm = 2000 * half_path_m;
        const double linear_mm = 1000 * half_path_m / slant;
        const double depth_mm = linear_mm / (1 - linear_mm * x * 90 / (path_mm * path_mm));
        const Eigen::Vector3d ray = Eigen::Vector3d(x, y, 1) / slant;
        const double range_m = range_from_half_path(half_path_m, ray, source_m);
        EXPECT_NEAR(range_m, depth_mm * slant / 1000, 5.1e-4);
      }
    }
  }
}

TEST(Kinect2LightSource, WithAPathThatNoSurfaceHasGivesNoRange) {
  const Eigen::Vector3d ray(0, 0, 1);
  for (const double half_path_m : {-1.0, 0.0, 0.0225, std::nan(""), -HUGE_VAL}) {
    EXPECT_TRUE(std::isnan(range_from_half_path(half_path_m, ray, source_m))) << half_path_m;
  }
  EXPECT_TRUE(std::isnan(half_path_from_range(-0.1, ray, source_m)));
  EXPECT_TRUE(std::isnan(half_path_from_range(std::nan(""), ray, source_m)));
  EXPECT_EQ(range_from_half_path(HUGE_VAL, ray, source_m), HUGE_VAL);
}

TEST(Kinect2LightSource, IsAllowedForByOneOffsetToHalfAMillimetreFromHalfAMetreOn) {
  const PixelRays rays = pixel_rays(camera_of(typical_intrinsics));
  const ImageF offset_m = half_path_offset(rays, source_m);
  EXPECT_GT(offset_m.abs().maxCoeff(), 0.012) << "what is left must be small against this";
  for (const double range_m : {0.5, 0.7, 1.0, 3.0, 18.0, 1000.0}) {
    double worst_m = 0;
    for (Eigen::Index i = 0; i < offset_m.size(); i += 97) {
      const Eigen::Vector3d ray =
          Eigen::Vector3d(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]).normalized();
      const double half_path_m = half_way(range_m * ray, source_m);
      worst_m = std::max(worst_m, std::abs(half_path_m - offset_m.data()[i] - range_m));
    }
    EXPECT_LT(worst_m, 0.52e-3) << range_m;
  }
}

TEST(Kinect2LightSource, HasAnOffsetForInfiniteRanges) {
  const PixelRays rays = pixel_rays(camera_of(typical_intrinsics));
  const double infinite = std::numeric_limits<double>::infinity();
  const ImageF far = half_path_offset(rays, source_m, infinite);
  const ImageF nearly = half_path_offset(rays, source_m, 1e4);
  EXPECT_LT((far - nearly).abs().maxCoeff(), 1e-6);
  EXPECT_GT(far(200, 0), 0.01) << "the source is on the right: the way to the left is longer";
  EXPECT_LT(far(200, 511), -0.01);
  EXPECT_THROW(half_path_offset(rays, source_m, 0), UsageError);
  EXPECT_THROW(half_path_offset(rays, source_m, std::nan("")), UsageError);
}

TEST(Kinect2LightSource, ShiftsPhasesByTheOffsetInWavelengths) {
  ImageF phase(1, 5);
  phase << 0.5F, 0.1F, 0.9F, nan, 0.2F;
  ImageF offset_m(1, 5);
  offset_m << 0.2F, 0.4F, -0.4F, 0.1F, 0.4F;
  const ImageF shifted = shifted_phase(phase, offset_m, 2);
  EXPECT_FLOAT_EQ(shifted(0), 0.4F);
  EXPECT_FLOAT_EQ(shifted(1), 0.9F);
  EXPECT_NEAR(shifted(2), 0.1F, 1e-6);
  EXPECT_TRUE(std::isnan(shifted(3)));
  EXPECT_LT(shifted(4), 1) << "a whole cycle is phase 0";
  EXPECT_GE(shifted(4), 0);
  EXPECT_THROW(shifted_phase(phase, ImageF::Zero(1, 4), 2), UsageError);
  EXPECT_THROW(shifted_phase(phase, offset_m, 0), UsageError);
}

TEST(Kinect2LightSource, ShiftsAPhaseJustBelowZeroToZeroAndNotToAWholeCycle) {
  const ImageF phase = ImageF::Zero(1, 1);
  const ImageF offset_m = ImageF::Constant(1, 1, 1e-12F);
  EXPECT_EQ(shifted_phase(phase, offset_m, 1)(0), 0);
}

TEST(Kinect2Mirror, ReversesColumns) {
  ImageF image(2, 3);
  image << 1, 2, 3, 4, 5, 6;
  ImageF reversed(2, 3);
  reversed << 3, 2, 1, 6, 5, 4;
  EXPECT_TRUE(same_values(mirrored(image), reversed));
}

TEST(Kinect2Mirror, GivesTheCameraThatSeesTheMirroredPointInTheMirroredColumn) {
  Intrinsics intrinsics = typical_intrinsics;
  intrinsics.p1 = 0.003;
  intrinsics.p2 = -0.002;
  const CameraModel camera = camera_of(intrinsics);
  for (const double u : {0.0, 100.0, 511.0}) {
    for (const double v : {0.0, 300.0, 423.0}) {
      const Eigen::Vector3d ray = pixel_ray(camera, u, v);
      const Eigen::Vector3d reversed = pixel_ray(mirrored(camera), 511 - u, v);
      EXPECT_LT((reversed - Eigen::Vector3d(-ray.x(), ray.y(), ray.z())).norm(), 1e-9);
    }
  }
}

TEST(Kinect2Intrinsics, PutTheFirstPixelsCentreWhereLibfreenect2Does) {
  Intrinsics intrinsics = typical_intrinsics;
  intrinsics.k1 = intrinsics.k2 = intrinsics.k3 = intrinsics.p1 = intrinsics.p2 = 0;
  const Eigen::Vector3d ray = pixel_ray(camera_of(intrinsics), 10, 20);
  EXPECT_NEAR(ray.x() / ray.z(), (10 + 0.5 - 254.878) / 365.456, 1e-12);
  EXPECT_NEAR(ray.y() / ray.z(), (20 + 0.5 - 205.395) / 365.456, 1e-12);
}

TEST(Kinect2Intrinsics, KeepEveryCoefficient) {
  const Intrinsics intrinsics{366, 367, 256, 208, 0.1, -0.2, 0.05, 0.003, -0.002};
  const CameraModel camera = camera_of(intrinsics);
  const std::array<double, 5> k1_k2_p1_p2_k3{0.1, -0.2, 0.003, -0.002, 0.05};
  EXPECT_EQ(camera.distortion, k1_k2_p1_p2_k3);
  const Intrinsics back = intrinsics_of(camera);
  EXPECT_EQ(back.fx, 366);
  EXPECT_EQ(back.fy, 367);
  EXPECT_EQ(back.cx, 256);
  EXPECT_EQ(back.cy, 208);
  EXPECT_EQ(back.k1, 0.1);
  EXPECT_EQ(back.k2, -0.2);
  EXPECT_EQ(back.k3, 0.05);
  EXPECT_EQ(back.p1, 0.003);
  EXPECT_EQ(back.p2, -0.002);
}

}  // namespace
}  // namespace tofmap::kinect2
