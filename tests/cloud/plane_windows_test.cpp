// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plane_windows.hpp"

#include "support/box_ranges.hpp"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// A wall across the view at 4 m.
RangeImage wall(float sigma_m) {
  return test::box_ranges(test::small_camera(), {-50, -50, -50}, {50, 50, 4}, Pose::Identity(),
                          sigma_m);
}

RangeImage noisy_wall(float sigma_m, unsigned seed) {
  RangeImage image = wall(sigma_m);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma_m);
  for (float& range_m : image.range_m.reshaped()) range_m += noise(random);
  return image;
}

/// The same after a mean over 7 x 7 pixels, within the image.
RangeImage averaged_wall(float sigma_m, unsigned seed) {
  constexpr Eigen::Index reach = 3;
  const RangeImage noisy = noisy_wall(sigma_m, seed);
  RangeImage out = wall(sigma_m);
  const ImageF off = noisy.range_m - out.range_m;
  out.averaged_px = ImageF::Ones(out.rows(), out.cols());
  for (Eigen::Index v = 0; v < out.rows(); ++v) {
    for (Eigen::Index u = 0; u < out.cols(); ++u) {
      const Eigen::Index top = std::max<Eigen::Index>(0, v - reach);
      const Eigen::Index left = std::max<Eigen::Index>(0, u - reach);
      const auto window = off.block(top, left, std::min(out.rows(), v + reach + 1) - top,
                                    std::min(out.cols(), u + reach + 1) - left);
      const auto pixels = static_cast<float>(window.size());
      out.range_m(v, u) += window.mean();
      out.sigma_m(v, u) = sigma_m / std::sqrt(pixels);
      out.averaged_px(v, u) = pixels;
    }
  }
  return out;
}

/// Normals of clouds of the wall beside what is said of them.
struct Normals {
  double share = 0;      ///< of points that have one
  double error_rad = 0;  ///< RMS of one of the two tilts
  double predicted_rad = 0;
};

Normals normals_of(RangeImage (*make)(float, unsigned), float sigma_m,
                   const CloudOptions& options) {
  constexpr unsigned seeds = 10;
  Normals out;
  double points = 0;
  double all = 0;
  for (unsigned seed = 900; seed < 900 + seeds; ++seed) {
    const SurfaceCloud cloud =
        surface_cloud(make(sigma_m, seed), pixel_rays(test::small_camera()), options);
    for (const SurfacePoint& point : cloud.points) {
      all += 1;
      if (!point.has_normal()) continue;
      points += 1;
      const double tilt_rad = std::acos(std::min(1.0F, -point.normal_z));
      out.error_rad += tilt_rad * tilt_rad / 2;
      out.predicted_rad += point.normal_sigma_rad * point.normal_sigma_rad;
    }
  }
  out.share = points / all;
  out.error_rad = std::sqrt(out.error_rad / points);
  out.predicted_rad = std::sqrt(out.predicted_rad / points);
  return out;
}

TEST(PlaneWindows, GrowWhereNoiseWouldLeaveNoNormals) {
  constexpr float sigma_m = 0.6F;
  CloudOptions fixed;
  fixed.max_window_radius_px = fixed.window_radius_px;
  EXPECT_LT(normals_of(noisy_wall, sigma_m, fixed).share, 0.6);
  const Normals grown = normals_of(noisy_wall, sigma_m, {});
  EXPECT_GT(grown.share, 0.9);
  // The larger of two tilts is predicted; neighbours are chosen with the noise's help.
  EXPECT_GT(grown.predicted_rad, 0.7 * grown.error_rad);
  EXPECT_LT(grown.predicted_rad, 1.6 * grown.error_rad);
}

TEST(PlaneWindows, StayAsTheyAreWhereNoiseIsSmall) {
  const RangeImage image = noisy_wall(0.02F, 900);
  const PixelRays rays = pixel_rays(test::small_camera());
  const PlaneFits fits(image, rays, {});
  const PlaneWindows windows(image, rays, {});
  PlaneRow expected(static_cast<std::size_t>(image.cols()));
  PlaneRow row(expected);
  std::vector<int> columns(static_cast<std::size_t>(image.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  for (int v = 0; v < image.rows(); ++v) {
    fits.fit(v, expected);
    fits.refit_folds(v, columns, nullptr, expected);
    windows.fit(v, row);
    EXPECT_EQ(row.q0, expected.q0);
    EXPECT_EQ(row.a_variance, expected.a_variance);
  }
}

TEST(PlaneWindows, CountNoiseThatPixelsShareOnce) {
  constexpr float sigma_m = 0.1F;
  const Normals normals = normals_of(averaged_wall, sigma_m, {});
  EXPECT_GT(normals.share, 0.9);
  EXPECT_GT(normals.predicted_rad, 0.8 * normals.error_rad);
  EXPECT_LT(normals.predicted_rad, 3 * normals.error_rad);
}

}  // namespace
}  // namespace tofmap
