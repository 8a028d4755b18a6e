// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/plane_edge_filter.hpp>
#include <tofmap/filters/step_edge_filter.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;
using test::rad_per_deg;
using test::slanted_plane;
using test::with_noise;

constexpr int pixels = 20 * 16;

RangeImage off_planes_dropped(const RangeImage& image) {
  return drop_off_planes(image, pixel_rays(camera()), {});
}

RangeImage steps_dropped(const RangeImage& image) {
  return drop_steps(image, pixel_rays(camera()), {});
}

/// A surface at 3 m on the left, one at 6 m on the right, and between them a column of flying
/// pixels.
RangeImage edge_with_flying_pixels() {
  RangeImage image = plane(3);
  image.range_m.rightCols(10) = plane(6).range_m.rightCols(10);
  image.range_m.col(10) = plane(4.2).range_m.col(10);
  return image;
}

TEST(PlaneEdgeFilter, KeepsPlanesWholeHoweverSlanted) {
  // The rays are up to 25° off the axis, so incidences go up to 89°.
  for (int slant_deg = -64; slant_deg <= 64; slant_deg += 8) {
    const RangeImage image = slanted_plane(3, slant_deg * rad_per_deg);
    ASSERT_TRUE((image.range_m > 0).all());
    EXPECT_EQ(off_planes_dropped(image).count_valid(), pixels) << slant_deg;
  }
}

TEST(PlaneEdgeFilter, KeepsNoisyPlanes) {
  int kept = 0;
  constexpr int seeds = 20;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const RangeImage image = with_noise(slanted_plane(3, 40 * rad_per_deg), 0.1F, seed);
    kept += off_planes_dropped(image).count_valid();
  }
  // Most of what goes is at the borders, which are a quarter of this small image.
  EXPECT_GT(kept, 0.97 * seeds * pixels);
}

TEST(PlaneEdgeFilter, DropsFlyingPixelsAndNothingElse) {
  const RangeImage out = off_planes_dropped(edge_with_flying_pixels());
  for (int v = 0; v < 16; ++v) {
    EXPECT_EQ(out.reason(v, 10), static_cast<int>(InvalidReason::jump_edge)) << v;
  }
  EXPECT_EQ(out.count_valid(), pixels - 16);
}

TEST(PlaneEdgeFilter, DropsFlyingPixelsOfASlantedEdge) {
  RangeImage image = plane(3);
  const RangeImage far = plane(6);
  int flying = 0;
  for (int v = 0; v < 16; ++v) {
    const int edge = 4 + v / 2;
    for (int u = edge; u < 20; ++u) image.range_m(v, u) = far.range_m(v, u);
    image.range_m(v, edge) *= 0.6F + 0.1F * static_cast<float>(v % 3);
    ++flying;
  }
  const RangeImage out = off_planes_dropped(image);
  for (int v = 0; v < 16; ++v) EXPECT_FALSE(out.valid(v, 4 + v / 2)) << v;
  // In the corner between the edge and a border of the image a pixel has too few neighbours.
  constexpr int in_corners = 4;
  EXPECT_GE(out.count_valid(), pixels - flying - in_corners);
}

TEST(PlaneEdgeFilter, DropsSinglePixelsOffTheirSurface) {
  for (const int v : {0, 7, 15}) {
    for (const int u : {0, 9, 19}) {
      RangeImage image = plane(3);
      image.range_m(v, u) += 0.3F;
      const RangeImage out = off_planes_dropped(image);
      EXPECT_FALSE(out.valid(v, u));
      EXPECT_EQ(out.count_valid(), pixels - 1);
    }
  }
}

TEST(PlaneEdgeFilter, HearsNothingFromInvalidPixelsAndBorders) {
  RangeImage image = plane(3);
  for (int v = 0; v < 16; ++v) image.invalidate(v, 5, InvalidReason::low_amplitude);
  const RangeImage out = off_planes_dropped(image);
  EXPECT_EQ(out.count_valid(), pixels - 16);
  EXPECT_EQ(out.reason(3, 5), static_cast<int>(InvalidReason::low_amplitude));
}

TEST(PlaneEdgeFilter, TakesImagesOfAnyShape) {
  for (const int size : {1, 2, 3}) {
    CameraModel small = camera();
    small.width_px = size;
    small.height_px = 1;
    const RangeImage image(1, size);
    EXPECT_EQ(drop_off_planes(image, pixel_rays(small), {}).count_valid(), 0);
  }
}

TEST(PlaneEdgeFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 19;
  EXPECT_THROW(drop_off_planes(plane(3), pixel_rays(other), {}), UsageError);
}

TEST(StepEdgeFilter, DropsFlyingPixelsAndNothingElse) {
  const RangeImage out = steps_dropped(edge_with_flying_pixels());
  for (int v = 0; v < 16; ++v) {
    EXPECT_EQ(out.reason(v, 10), static_cast<int>(InvalidReason::jump_edge)) << v;
  }
  EXPECT_EQ(out.count_valid(), pixels - 16);
}

TEST(StepEdgeFilter, KeepsSlopesUpToItsAngleAndDropsSteeperOnes) {
  const auto dropped_at = [](double max_incidence_deg) {
    // Incidences from 15° to 65°, the largest in the right-most columns.
    const RangeImage image = slanted_plane(3, -40 * rad_per_deg);
    const StepEdgeLimits limits{.max_incidence_rad = max_incidence_deg * rad_per_deg,
                                .min_sigmas = 0};
    return pixels - drop_steps(image, pixel_rays(camera()), limits).count_valid();
  };
  EXPECT_EQ(dropped_at(75), 0);
  EXPECT_GT(dropped_at(45), 20);
}

TEST(StepEdgeFilter, TakesNoNoiseForASlope) {
  const RangeImage image = with_noise(plane(3), 0.5F, 1);
  EXPECT_GT(steps_dropped(image).count_valid(), 0.99 * pixels);
}

TEST(StepEdgeFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 19;
  EXPECT_THROW(drop_steps(plane(3), pixel_rays(other), {}), UsageError);
}

}  // namespace
}  // namespace tofmap
