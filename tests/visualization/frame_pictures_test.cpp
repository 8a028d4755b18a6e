// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pixel_count.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/visualization/cloud_pictures.hpp>
#include <tofmap/visualization/frame_pictures.hpp>

namespace tofmap {
namespace {

using test::count;

TEST(RangePicture, ShowsBothImagesOnOneScale) {
  ImageF wrapped = ImageF::Constant(10, 20, 2);
  ImageF unwrapped = ImageF::Constant(10, 20, 7);
  wrapped(0, 0) = NAN;
  unwrapped(0, 0) = NAN;
  const Picture picture = range_picture(wrapped, unwrapped);
  const ColorScale scale(0, 7, "range, m");
  const int square = (530 / 20) * (530 / 20);
  // All but one pixel of each; the legend's bar has a few of the same colours.
  EXPECT_NEAR(count(picture, scale(2)), 199 * square, square);
  EXPECT_NEAR(count(picture, scale(7)), 199 * square, square);
  EXPECT_GE(count(picture, colors::invalid), 2 * square);
}

TEST(RangePicture, OfAFrameWithoutReturnsIsDrawnAllTheSame) {
  const ImageF none = ImageF::Constant(10, 20, NAN);
  EXPECT_GT(count(range_picture(none, none), colors::invalid), 0);
}

TEST(WrapCountPicture, HasAColorForEveryCount) {
  ImageU8 counts = ImageU8::Zero(10, 20);
  counts.rightCols(5).setConstant(3);
  counts.leftCols(1).setConstant(invalid_wrap_count);
  const Picture picture = wrap_count_picture(counts);
  const int square = (530 / 20) * (530 / 20);
  EXPECT_NEAR(count(picture, wrap_count_color(0)), 140 * square, square);
  EXPECT_NEAR(count(picture, wrap_count_color(3)), 50 * square, square);
  EXPECT_NEAR(count(picture, colors::invalid), 10 * square, square);
  EXPECT_EQ(count(picture, wrap_count_color(1)), 0) << "the legend names what occurs alone";
}

TEST(MethodPicture, ShowsWhichPixelsAreWrapsOff) {
  const ImageF truth = ImageF::Constant(20, 20, 6);
  MethodRanges near{"near", truth - 5};
  MethodRanges right{"right", truth + 0.1F};
  const Picture one = method_picture({near}, truth, 5);
  const Picture two = method_picture({near, right}, truth, 5);
  const Rgb too_near{0, 90, 181};
  const auto count = [&](const Picture& picture) {
    return std::count(picture.pixels.begin(), picture.pixels.end(), too_near);
  };
  EXPECT_GT(count(one), 340 * 340);
  EXPECT_EQ(count(one), count(two)) << "what is right is not blue";
  EXPECT_GT(two.width_px, one.width_px + 340);
  // Without truth there are no errors to draw.
  EXPECT_EQ(count(method_picture({near}, ImageF(), 5)), 0);
}

TEST(FilterPicture, ShowsWhatIsRemovedByItsReason) {
  FilteredRanges image{"a filter", ImageF::Constant(10, 20, 7), ImageU8::Zero(10, 20)};
  image.range_m(0, 0) = NAN;
  image.reason(0, 0) = static_cast<std::uint8_t>(InvalidReason::no_return);
  const int square = (530 / 20) * (530 / 20);
  const Rgb edge{214, 39, 40};
  EXPECT_EQ(count(filter_picture({image}), edge), 0) << "the legend names what occurs alone";
  image.reason.row(4).setConstant(static_cast<std::uint8_t>(InvalidReason::jump_edge));
  const Picture picture = filter_picture({image});
  EXPECT_NEAR(count(picture, edge), 20 * square, square);
  EXPECT_NEAR(count(picture, ColorScale(0, 7, "range, m")(7)), 179 * square, square);
  EXPECT_GE(count(picture, colors::invalid), square) << "what had no range before is not removed";
}

TEST(JumpPicture, MixesColorsByProbability) {
  std::array<ImageF, 3> x;
  for (ImageF& plane : x) plane = ImageF::Zero(10, 19);
  x[1].setConstant(1);
  std::array<ImageF, 3> y = x;
  x[0].col(4).setConstant(1);
  x[1].col(4).setConstant(0);
  const Picture picture = jump_picture({{"result", &x, &y}});
  const int square = (530 / 19) * (530 / 19);
  EXPECT_NEAR(count(picture, jump_color(1, 0, 0)), 10 * square, square);
  EXPECT_NEAR(count(picture, jump_color(0, 1, 0)), (180 + 190) * square, square);
}

TEST(ConfidencePicture, ColoursSureUnsureAndInvalidPixelsApart) {
  RangeImage image(20, 30);
  image.reason.leftCols(20).setZero();
  image.range_m.leftCols(20).setConstant(3);
  image.confidence.leftCols(10).setConstant(1);
  image.confidence.middleCols(10, 10).setConstant(0.2F);
  const ColorScale scale(0, 1, "");
  const Picture picture = confidence_picture(image);
  const int square = (530 / 30) * (530 / 30);
  for (const double confidence : {1.0, 0.2}) {
    EXPECT_GE(count(picture, scale(confidence)), 200 * square) << confidence;
  }
  EXPECT_GE(count(picture, colors::invalid), 200 * square);
}

TEST(CloudPicture, ShowsCorrectedPixelsInRed) {
  CameraModel camera;
  camera.width_px = 40;
  camera.height_px = 30;
  camera.fx_px = camera.fy_px = 40;
  camera.cx_px = 19.5;
  camera.cy_px = 14.5;
  RangeImage image(30, 40);
  image.range_m.setConstant(3);
  image.wrap_count.setZero();
  image.reason.setZero();
  ImageF wrapped = image.range_m;
  const PixelRays rays = pixel_rays(camera);
  const auto dots = [&] { return count(cloud_picture(image, wrapped, rays), colors::corrected); };
  const int legend_alone = dots();
  image.range_m.leftCols(20).setConstant(7);
  image.wrap_count.leftCols(20).setConstant(1);
  wrapped.leftCols(20).setConstant(1.8F);
  EXPECT_GT(dots(), legend_alone + 500);
}

TEST(CloudPicture, OfAFrameWithoutReturnsIsDrawnAllTheSame) {
  CameraModel camera;
  camera.width_px = camera.height_px = 8;
  camera.fx_px = camera.fy_px = 8;
  const PixelRays rays = pixel_rays(camera);
  const RangeImage none(8, 8);
  EXPECT_GT(cloud_picture(none, none.range_m, rays).width_px, 0);
}

}  // namespace
}  // namespace tofmap
