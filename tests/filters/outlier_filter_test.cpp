// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
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

TEST(OutlierFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 10;
  EXPECT_THROW(drop_outliers(plane(3), pixel_rays(other), deviations), UsageError);
}

}  // namespace
}  // namespace tofmap
