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
using test::frame_of;
using test::modulation;
using test::plane;
using test::rad_per_deg;
using test::slanted_plane;
using test::with_noise;

constexpr int pixels = 20 * 16;

/// The image with the wrap counts of its ranges.
RangeImage counted(RangeImage image) {
  const auto wavelength_m = static_cast<float>(modulation().wavelength_m(0));
  image.wrap_count = (image.range_m / wavelength_m).floor().cast<std::uint8_t>();
  return image;
}

RangeImage off_planes_dropped(const RangeImage& image, const Frame& frame) {
  return drop_off_planes(counted(image), frame, modulation(), pixel_rays(camera()), {});
}

/// With frequencies that agree.
RangeImage off_planes_dropped(const RangeImage& image) {
  return off_planes_dropped(image, frame_of(image.range_m));
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

TEST(PlaneEdgeFilter, DropsPixelsWhoseFrequenciesDisagree) {
  const RangeImage image = plane(3);
  Frame frame = frame_of(image.range_m);
  // Their mean is on the surface; A alone is off by 15 cm.
  frame.phases[0](7, 9) += static_cast<float>(0.15 / modulation().wavelength_m(0));
  frame.phases[1](7, 9) -= static_cast<float>(0.15 / modulation().wavelength_m(1));
  const RangeImage out = off_planes_dropped(image, frame);
  EXPECT_FALSE(out.valid(7, 9));
  EXPECT_EQ(out.count_valid(), pixels - 1);
}

TEST(PlaneEdgeFilter, KeepsSurfacesOfFrequenciesThatAreOffAsAWhole) {
  const RangeImage image = slanted_plane(3, 30 * rad_per_deg);
  Frame frame = frame_of(image.range_m);
  frame.phases[1] += static_cast<float>(0.2 / modulation().wavelength_m(1));
  frame.phases[1] -= frame.phases[1].floor();
  EXPECT_EQ(off_planes_dropped(image, frame).count_valid(), pixels);
}

TEST(PlaneEdgeFilter, DropsABandOfFlyingPixels) {
  RangeImage image = edge_with_flying_pixels();
  for (int v = 0; v < 16; ++v) image.range_m(v, 10) *= 0.85F + 0.1F * static_cast<float>(v % 4);
  for (int v = 0; v < 16; ++v) image.range_m(v, 11) *= 0.8F + 0.05F * static_cast<float>(v % 3);
  const RangeImage out = off_planes_dropped(image);
  EXPECT_EQ((out.reason.middleCols(10, 2) == 0).count(), 0);
  EXPECT_EQ(out.count_valid(), pixels - 2 * 16);
}

TEST(PlaneEdgeFilter, KeepsTheCornersOfASurfaceBeforeAnother) {
  RangeImage image = plane(6);
  image.range_m.block(5, 6, 6, 7) = plane(3).range_m.block(5, 6, 6, 7);
  EXPECT_EQ(off_planes_dropped(image).count_valid(), pixels);
}

TEST(PlaneEdgeFilter, FindsFlyingPixelsInNoiseAndKeepsTheSurfacesBesideThem) {
  constexpr float sigma_m = 0.1F;
  constexpr int seeds = 20;
  int flying_left = 0;
  int kept = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const RangeImage image = with_noise(edge_with_flying_pixels(), sigma_m, seed);
    const RangeImage out = off_planes_dropped(image);
    flying_left += static_cast<int>((out.reason.col(10) == 0).count());
    kept += out.count_valid();
  }
  // Flying pixels are twelve standard deviations from both surfaces, so that hardly any may stay.
  EXPECT_LT(flying_left, 0.01 * seeds * 16);
  // The borders of the image and of the edge, where predictions are few, are half of all pixels.
  EXPECT_GT(kept - flying_left, 0.95 * seeds * (pixels - 16));
}

TEST(PlaneEdgeFilter, TreatsTheFirstColumnLikeTheLast) {
  // An edge between an upper and a lower surface, and a row of pixels that moves from one to the
  // other, through the limits of planes and of edges. All is symmetric about the middle column.
  int dropped = 0;
  for (int i = 1; i < 60; ++i) {
    RangeImage image = plane(3);
    image.sigma_m.setConstant(0.05F);
    image.range_m.bottomRows(8) = plane(5).range_m.bottomRows(8);
    image.range_m.row(7) = plane(3 + 0.01F * static_cast<float>(i)).range_m.row(7);
    const RangeImage out = off_planes_dropped(image);
    for (Eigen::Index v = 0; v < out.rows(); ++v) {
      EXPECT_EQ(out.valid(v, 0), out.valid(v, out.cols() - 1)) << "offset " << i << ", row " << v;
      dropped += out.valid(v, 0) ? 0 : 1;
    }
  }
  EXPECT_GT(dropped, 0);
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
    const RangeImage out =
        drop_off_planes(image, frame_of(image.range_m), modulation(), pixel_rays(small), {});
    EXPECT_EQ(out.count_valid(), 0);
  }
}

TEST(PlaneEdgeFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 19;
  const RangeImage image = plane(3);
  EXPECT_THROW(drop_off_planes(image, frame_of(image.range_m), modulation(), pixel_rays(other), {}),
               UsageError);
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
    const StepEdgeLimits limits{.max_incidence_deg = max_incidence_deg, .min_sigmas = 0};
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
