// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/plot.hpp>

namespace tofmap {
namespace {

constexpr Rgb first_line{0, 114, 178};

Plot rising() {
  return {.title = "a plot",
          .x_label = "x, m",
          .y_label = "y, %",
          .lines = {{"rising", {0, 5, 10}, {0, 50, 100}}},
          .x_limit = 10,
          .y_limit = 100};
}

/// Pixels of the first line's colour within a part of the picture.
std::ptrdiff_t count_line(const Picture& picture, int from_x, int to_x, int from_y, int to_y) {
  std::ptrdiff_t count = 0;
  for (int y = from_y; y < to_y; ++y) {
    for (int x = from_x; x < to_x; ++x) count += picture.at(x, y) == first_line ? 1 : 0;
  }
  return count;
}

TEST(PlotPicture, DrawsALineFromTheLowerLeftToTheUpperRight) {
  const Picture picture = plot_picture(rising(), 600, 400);
  ASSERT_EQ(picture.width_px, 600);
  ASSERT_EQ(picture.height_px, 400);
  EXPECT_GT(count_line(picture, 0, 300, 200, 400), 50) << "lower left";
  EXPECT_GT(count_line(picture, 400, 600, 0, 200), 50) << "upper right";
  EXPECT_EQ(count_line(picture, 400, 600, 250, 400), 0) << "lower right";
}

TEST(PlotPicture, LeavesAGapWhereThereIsNoValue) {
  Plot plot = rising();
  plot.lines[0].x = {0, 3, 5, 7, 10};
  plot.lines[0].y = {0, 30, std::nan(""), 70, 100};
  const Picture picture = plot_picture(plot, 600, 400);
  EXPECT_EQ(count_line(picture, 280, 340, 150, 250), 0);
  EXPECT_GT(count_line(picture, 0, 280, 200, 400), 20) << "before the gap";
  EXPECT_GT(count_line(picture, 340, 600, 0, 200), 20) << "after the gap";
}

TEST(PlotPicture, FindsItsLimitsItself) {
  Plot plot = rising();
  plot.x_limit = plot.y_limit = 0;
  plot.lines[0].y = {0, 0.5, 1};
  EXPECT_GT(count_line(plot_picture(plot, 600, 400), 400, 600, 0, 200), 50);
}

TEST(PlotPicture, SpreadsDecadesEvenlyOnALogarithmicAxis) {
  Plot plot = rising();
  plot.has_log_y = true;
  plot.y_limit = 0;
  plot.lines[0] = {"decades", {0, 5, 10}, {0.001, 0.01, 0.1}};
  const Picture picture = plot_picture(plot, 600, 400);
  // On a linear axis the middle of the line would be near the bottom.
  EXPECT_GT(count_line(picture, 260, 340, 130, 250), 20);
  plot.lines[0].y = {0, -1, 0.1};
  const Picture with_gap = plot_picture(plot, 600, 400);
  EXPECT_EQ(count_line(with_gap, 260, 340, 130, 250), 0) << "what is not positive is a gap";
  EXPECT_GT(count_line(with_gap, 340, 600, 0, 130), 2) << "the last point is drawn";
}

TEST(PlotPicture, MarksSinglePointsWithoutComplaint) {
  Plot plot = rising();
  plot.lines[0].x = {2, 5, 8};
  plot.lines[0].y = {20, std::nan(""), 80};
  plot.lines.push_back({"one", {5}, {50}});
  testing::internal::CaptureStderr();
  const Picture picture = plot_picture(plot, 600, 400);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(count_line(picture, 0, 300, 200, 400), 5) << "lower left";
  EXPECT_GT(count_line(picture, 300, 600, 0, 200), 5) << "upper right";
}

TEST(PlotPicture, HasAxesWithoutLines) {
  Plot plot = rising();
  plot.lines[0].x.clear();
  plot.lines[0].y.clear();
  const Picture picture = plot_picture(plot, 300, 200);
  ASSERT_EQ(picture.width_px, 300);
  EXPECT_EQ(count_line(picture, 0, 300, 0, 200), 0);
  int inked = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 300; ++x) inked += picture.at(x, y) == picture.at(0, 0) ? 0 : 1;
  }
  EXPECT_GT(inked, 1000) << "axes, title and labels";
}

TEST(PlotPicture, RefusesALineWithoutAsManyXAsY) {
  Plot plot = rising();
  plot.lines[0].x.pop_back();
  EXPECT_THROW(plot_picture(plot, 300, 200), UsageError);
}

}  // namespace
}  // namespace tofmap
