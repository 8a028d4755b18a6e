// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/filters/outlier_filter.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;
using test::slanted_plane;
using test::with_noise;

constexpr double deviations = 5;

int kept(const RangeImage& image) {
  return drop_outliers(image, pixel_rays(camera()), deviations).count_valid();
}

TEST(OutlierFilter, DropsAPointByItself) {
  RangeImage image = plane(3);
  image.range_m(7, 9) -= 1.5F;
  const RangeImage out = drop_outliers(image, pixel_rays(camera()), deviations);
  EXPECT_EQ(out.count_valid(), 20 * 16 - 1);
  EXPECT_EQ(out.reason(7, 9), static_cast<int>(InvalidReason::outlier));
}

TEST(OutlierFilter, DropsAPointWithTooFewAroundIt) {
  RangeImage image = plane(3);
  for (int v = 5; v <= 9; ++v) {
    for (int u = 7; u <= 11; ++u) {
      if (v != 7 || u != 9) image.invalidate(v, u, InvalidReason::no_return);
    }
  }
  EXPECT_FALSE(drop_outliers(image, pixel_rays(camera()), deviations).valid(7, 9));
}

TEST(OutlierFilter, DoesNotPunishDistance) {
  // The right half is ten times as far, so its points are ten times as far apart.
  RangeImage image = plane(1);
  const RangeImage far = plane(10);
  image.range_m.rightCols(10) = far.range_m.rightCols(10);
  EXPECT_EQ(kept(image), 20 * 16);
}

TEST(OutlierFilter, DoesNotPunishNoiseThatIsExpected) {
  // But for its tail: a range four standard deviations off is an outlier.
  EXPECT_GE(kept(with_noise(plane(3), 0.3F, 7)), 0.98 * 20 * 16);
}

TEST(OutlierFilter, KeepsSlantedSurfaces) {
  const RangeImage image = slanted_plane(3, 45 * test::rad_per_deg);
  EXPECT_EQ(kept(image), image.count_valid());
}

struct Pixel {
  int u;
  int v;
};

/// The spacing of two pixels, squared (docs/filters.md, equation 8).
double spacing2(const RangeImage& image, const PixelRays& rays, Pixel a, Pixel b) {
  const Eigen::Vector3d between(rays.x(a.v, a.u) - rays.x(b.v, b.u),
                                rays.y(a.v, a.u) - rays.y(b.v, b.u),
                                rays.z(a.v, a.u) - rays.z(b.v, b.u));
  const double angle2 = between.squaredNorm();
  const double r = image.range_m(a.v, a.u);
  const double s = image.range_m(b.v, b.u);
  const double noise2 = std::pow(image.sigma_m(a.v, a.u), 2) + std::pow(image.sigma_m(b.v, b.u), 2);
  return ((r - s) * (r - s) + r * s * angle2) / (std::pow(std::min(r, s), 2) * angle2 + noise2);
}

/// The score of a pixel: the mean spacing to the nearest quarter of the valid pixels around it.
/// Nothing if there are fewer than four.
std::optional<double> score(const RangeImage& image, const PixelRays& rays, Pixel pixel) {
  std::vector<double> spacings;
  for (int v = std::max(0, pixel.v - 2); v <= std::min(15, pixel.v + 2); ++v) {
    for (int u = std::max(0, pixel.u - 2); u <= std::min(19, pixel.u + 2); ++u) {
      if ((v == pixel.v && u == pixel.u) || !image.valid(v, u)) continue;
      spacings.push_back(std::sqrt(spacing2(image, rays, pixel, {u, v})));
    }
  }
  if (spacings.size() < 4) return std::nullopt;
  std::ranges::sort(spacings);
  const auto nearest = std::lround(static_cast<double>(spacings.size()) / 4);
  return std::accumulate(spacings.begin(), spacings.begin() + nearest, 0.0) /
         static_cast<double>(nearest);
}

TEST(OutlierFilter, DropsWhatEquation8Drops) {
  // All pixels are there on the right, almost none on the left, so that all numbers of neighbours
  // occur.
  const PixelRays rays = pixel_rays(camera());
  RangeImage image = with_noise(plane(3), 0.1F, 1);
  std::mt19937 random(2);
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 20; ++u) {
      if (static_cast<int>(random() % 20) > u) image.invalidate(v, u, InvalidReason::no_return);
      if (random() % 10 == 0) image.range_m(v, u) += 0.5F;
    }
  }
  std::vector<double> scores;
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 20; ++u) {
      const auto value = image.valid(v, u) ? score(image, rays, {u, v}) : std::nullopt;
      if (value) scores.push_back(*value);
    }
  }
  const double middle = median(scores);
  std::vector<double> off;
  for (const double value : scores) off.push_back(std::abs(value - middle));
  const double limit = middle + 2 * std::max(0.1, 1.4826 * median(off));

  const RangeImage out = drop_outliers(image, rays, 2);
  int dropped = 0;
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 20; ++u) {
      if (!image.valid(v, u)) continue;
      const auto value = score(image, rays, {u, v});
      EXPECT_EQ(out.valid(v, u), value && *value <= limit) << u << ", " << v;
      dropped += out.valid(v, u) ? 0 : 1;
    }
  }
  EXPECT_GT(dropped, 8) << "so that there is something to compare";
}

TEST(OutlierFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 10;
  EXPECT_THROW(drop_outliers(plane(3), pixel_rays(other), deviations), UsageError);
}

}  // namespace
}  // namespace tofmap
