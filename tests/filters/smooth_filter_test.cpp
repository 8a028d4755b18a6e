// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/smooth_filter.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;
using test::rad_per_deg;
using test::slanted_plane;
using test::with_noise;

RangeImage smoothed(const RangeImage& image) {
  return smooth_ranges(image, pixel_rays(camera()), {});
}

/// Errors of many noisy images of a surface, smoothed.
struct Errors {
  double mean_m = 0;
  double rms_m = 0;
  double predicted_m = 0;  ///< RMS of sigma_m
};

Errors errors_of(const RangeImage& surface, float sigma_m) {
  constexpr unsigned seeds = 100;
  Errors errors;
  double squares = 0;
  double variances = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const RangeImage out = smoothed(with_noise(surface, sigma_m, seed));
    const Image<double> off = (out.range_m - surface.range_m).cast<double>();
    errors.mean_m += off.mean() / seeds;
    squares += off.square().mean() / seeds;
    variances += out.sigma_m.cast<double>().square().mean() / seeds;
  }
  errors.rms_m = std::sqrt(squares);
  errors.predicted_m = std::sqrt(variances);
  return errors;
}

TEST(SmoothFilter, HalvesNoiseAndLeavesPlanesWhereTheyAre) {
  for (const double slant_deg : {0, 30, 60}) {
    const RangeImage surface = slanted_plane(3, slant_deg * rad_per_deg);
    for (const float sigma_m : {0.01F, 0.05F}) {
      const Errors errors = errors_of(surface, sigma_m);
      EXPECT_LT(errors.rms_m, 0.5 * sigma_m) << slant_deg;
      EXPECT_LT(std::abs(errors.mean_m), 0.001) << slant_deg;
      // sigma_m takes pairs as chosen whatever the pixel's own noise; choosing those that agree
      // with it keeps a fifth more.
      EXPECT_GT(errors.rms_m, 0.95 * errors.predicted_m) << slant_deg;
      EXPECT_LT(errors.rms_m, 1.3 * errors.predicted_m) << slant_deg;
    }
  }
}

TEST(SmoothFilter, LeavesEdgesWhereTheyAre) {
  constexpr float step_m = 0.4F;
  RangeImage surface = plane(3);
  surface.range_m.rightCols(10) = plane(3 + step_m).range_m.rightCols(10);
  constexpr float sigma_m = 0.03F;
  constexpr int seeds = 20;
  double squares_at_edge = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const RangeImage out = smoothed(with_noise(surface, sigma_m, seed));
    const ImageF off = (out.range_m - surface.range_m).abs();
    EXPECT_LT(off.maxCoeff(), step_m / 2) << "a pixel changed sides";
    squares_at_edge += off.middleCols(9, 2).square().mean() / seeds;
  }
  // Next to the edge only pairs along it agree, and once in a thousand times one across it.
  EXPECT_LT(std::sqrt(squares_at_edge), 0.8 * sigma_m);
}

TEST(SmoothFilter, HearsNothingOfPixelsThatAreFarTooNear) {
  RangeImage image = plane(3, 0.02F);
  for (int v = 5; v < 12; ++v) {
    image.range_m(v, 9) = 0.06F;  // its inverse depth may be anything
    image.sigma_m(v, 9) = 0.03F;
  }
  const RangeImage out = smoothed(image);
  // 1 / z is corrected for noise, which is not there: by σ² / z.
  constexpr float correction_m = 0.02F * 0.02F / 3;
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 20; ++u) {
      const bool is_too_near = v >= 5 && v < 12 && u == 9;
      EXPECT_NEAR(out.range_m(v, u), image.range_m(v, u),
                  is_too_near ? 0.03F : 1.3F * correction_m);
    }
  }
}

TEST(SmoothFilter, MixesNoTwoSurfacesInANoisyPixelBetweenThem) {
  RangeImage image = plane(6, 0.03F);
  image.range_m.rightCols(10) = plane(9).range_m.rightCols(10);
  image.range_m(8, 9) = 6.7F;  // of the nearer surface, by one standard deviation
  image.sigma_m(8, 9) = 0.7F;
  const RangeImage out = smoothed(image);
  EXPECT_LT(out.range_m(8, 9), 6.7F);
}

TEST(SmoothFilter, InventsNoRangesAndDropsNone) {
  RangeImage image = with_noise(plane(3), 0.02F, 1);
  image.invalidate(7, 9, InvalidReason::no_return);
  image.invalidate(0, 0, InvalidReason::low_confidence);
  const RangeImage out = smoothed(image);
  EXPECT_TRUE((out.reason == image.reason).all());
  EXPECT_TRUE((out.range_m.isNaN() == image.range_m.isNaN()).all());
  EXPECT_TRUE((out.sigma_m.isNaN() == image.sigma_m.isNaN()).all());
}

TEST(SmoothFilter, HearsLittleOfPixelsThatAreNotSure) {
  RangeImage image = plane(3, 0.05F);
  image.range_m.col(9) += 0.1F;  // within what noise explains
  const float believed = smoothed(image).range_m(8, 10);
  image.confidence.col(9).setConstant(0.05F);
  const float down_weighted = smoothed(image).range_m(8, 10);
  const float truth = plane(3).range_m(8, 10);
  EXPECT_LT(std::abs(down_weighted - truth), 0.3F * std::abs(believed - truth));
}

TEST(SmoothFilter, LeavesPixelsThatAreMeansAlready) {
  RangeImage image = with_noise(plane(3), 0.02F, 1);
  image.averaged_px = ImageF::Ones(image.rows(), image.cols());
  image.averaged_px.leftCols(10).setConstant(30);
  const RangeImage out = smoothed(image);
  EXPECT_TRUE((out.range_m.leftCols(10) == image.range_m.leftCols(10)).all());
  EXPECT_TRUE((out.sigma_m.leftCols(10) == image.sigma_m.leftCols(10)).all());
  EXPECT_LT(out.sigma_m.rightCols(10).mean(), 0.6F * image.sigma_m.rightCols(10).mean());
}

TEST(SmoothFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 19;
  EXPECT_THROW(smooth_ranges(plane(3), pixel_rays(other), {}), UsageError);
}

}  // namespace
}  // namespace tofmap
