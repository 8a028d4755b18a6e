// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plane_fit.hpp"

#include "plain_plane_fit.hpp"
#include "support/box_ranges.hpp"

#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// A corner of a room behind the edge of a near wall, with noise, holes and wild pixels.
RangeImage difficult_image() {
  const CameraModel camera = test::small_camera();
  RangeImage image = test::box_ranges(camera, {-1.5, -1, -1}, {2, 1.2, 4},
                                      test::moved_by({0.1, 0.6, 0}, {0, 0, 0}), 0.02F);
  const RangeImage near = test::box_ranges(camera, {-9, -9, -9}, {9, 9, 1.5}, Pose::Identity());
  image.range_m.leftCols(20) = near.range_m.leftCols(20);
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0, 0.02F);
  std::uniform_int_distribution<Eigen::Index> pixel(0, image.range_m.size() - 1);
  for (float& range_m : image.range_m.reshaped()) range_m += noise(random);
  for (int i = 0; i < 100; ++i) image.range_m.data()[pixel(random)] += 0.5F;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Index at = pixel(random);
    image.invalidate(at / image.cols(), at % image.cols(), InvalidReason::no_return);
  }
  return image;
}

TEST(PlaneFits, AgreeWithAPlainFitOfEachPixel) {
  const PixelRays rays = pixel_rays(test::small_camera());
  for (const int radius : {1, 3, 5}) {
    CloudOptions options;
    options.window_radius_px = radius;
    options.min_neighbours = radius == 1 ? 5 : 12;
    const RangeImage image = difficult_image();
    const PlaneFits fits(image, rays, options);
    const test::PlainPlaneFit plain(image, rays, options);
    PlaneRow planes(static_cast<std::size_t>(image.cols()));
    int pixels = 0;
    int other_neighbours = 0;
    int other_planes = 0;
    for (int row = 0; row < image.rows(); ++row) {
      fits.fit(row, planes);
      for (int col = 0; col < image.cols(); ++col) {
        if (!image.valid(row, col)) continue;
        ++pixels;
        const auto i = static_cast<std::size_t>(col);
        const test::PlainPlane expected = plain.fit(row, col);
        if (planes.neighbours[i] != expected.neighbours) {
          ++other_neighbours;
          continue;
        }
        if (expected.neighbours == 0) continue;
        const Eigen::Vector3d sigmas = expected.variances.cwiseSqrt();
        const Eigen::Vector3d error(planes.q0[i] - expected.q0, planes.a[i] - expected.a,
                                    planes.b[i] - expected.b);
        const Eigen::Vector3d variances(planes.q0_variance[i], planes.a_variance[i],
                                        planes.b_variance[i]);
        const bool is_same = error.cwiseQuotient(sigmas).cwiseAbs().maxCoeff() < 0.01 &&
                             variances.isApprox(expected.variances, 0.01);
        other_planes += is_same ? 0 : 1;
      }
    }
    EXPECT_GT(pixels, 6000);
    // Rounding decides at the gates, and is amplified from fit to fit.
    EXPECT_LT(other_neighbours, pixels / 200) << radius;
    EXPECT_LT(other_planes, pixels / 1000) << "as many, but others; " << radius;
  }
}

TEST(PlaneFits, OfNeighboursOnOneLineHaveNoNormal) {
  RangeImage image = difficult_image();
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    if (row == 40) continue;
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      image.invalidate(row, col, InvalidReason::no_return);
    }
  }
  CloudOptions options;
  options.min_neighbours = 3;
  const SurfaceCloud cloud = surface_cloud(image, pixel_rays(test::small_camera()), options);
  for (const SurfacePoint& point : cloud.points) EXPECT_FALSE(point.has_normal());
}

}  // namespace
}  // namespace tofmap
