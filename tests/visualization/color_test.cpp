// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/color.hpp>

namespace tofmap {
namespace {

/// How light a colour looks: relative luminance of sRGB, to the power that evens it out.
double lightness(Rgb color) {
  const auto linear = [](std::uint8_t value) { return std::pow(value / 255.0, 2.2); };
  return std::cbrt(0.2126 * linear(color.red) + 0.7152 * linear(color.green) +
                   0.0722 * linear(color.blue));
}

TEST(ColorScale, GrowsLighterEvenly) {
  const ColorScale scale(0, 1, "share");
  constexpr int steps = 16;
  const double mean_step = (lightness(scale(1)) - lightness(scale(0))) / steps;
  for (int i = 0; i < steps; ++i) {
    const double step = lightness(scale((i + 1.0) / steps)) - lightness(scale(1.0 * i / steps));
    EXPECT_GT(step, 0.3 * mean_step) << i;
    EXPECT_LT(step, 2.5 * mean_step) << i;
  }
}

TEST(ColorScale, ShowsErrorsEverDarker) {
  const ColorScale scale(0, 1, "error", ColorRamp::error);
  for (int i = 0; i < 16; ++i) {
    EXPECT_LT(lightness(scale((i + 1) / 16.0)), lightness(scale(i / 16.0))) << i;
  }
}

TEST(ColorScale, StopsAtItsLimitsAndShowsMissingValuesAsSuch) {
  const ColorScale scale(2, 4, "range, m");
  EXPECT_EQ(scale(1), scale(2));
  EXPECT_EQ(scale(99), scale(4));
  EXPECT_EQ(scale(NAN), colors::invalid);
  EXPECT_NE(scale(2), colors::invalid);
}

TEST(ColorScale, HasRoundTicks) {
  EXPECT_EQ(ColorScale(0, 10, "").ticks(5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ColorScale(-1, 1.2, "").ticks(4), (std::vector<double>{-1, 0, 1}));
  EXPECT_FALSE(std::signbit(ColorScale(0, 10, "").ticks(5).front())) << "not -0";
}

TEST(ColorScale, RefusesLimitsThatAreNotInOrder) {
  EXPECT_THROW(ColorScale(1, 1, ""), UsageError);
  EXPECT_THROW(ColorScale(0, NAN, ""), UsageError);
}

TEST(WrapCountColors, DifferBetweenNeighbours) {
  for (int count = 0; count < 20; ++count) {
    EXPECT_NE(wrap_count_color(count), wrap_count_color(count + 1)) << count;
  }
}

TEST(JumpColors, AreThoseOfThePaper) {
  EXPECT_EQ(jump_color(1, 0, 0), (Rgb{0, 0, 255}));
  EXPECT_EQ(jump_color(0, 1, 0), (Rgb{0, 255, 0}));
  EXPECT_EQ(jump_color(0, 0, 1), (Rgb{255, 0, 0}));
  EXPECT_EQ(jump_color(NAN, NAN, NAN), colors::invalid);
}

}  // namespace
}  // namespace tofmap
