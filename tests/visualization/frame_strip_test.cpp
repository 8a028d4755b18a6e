// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frame_colors.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/color.hpp>
#include <tofmap/visualization/frame_strip.hpp>

namespace tofmap {
namespace {

using testing::HasSubstr;

/// Pixels at 2 m, and twice at 7 m with a wrap; filters take the second away.
StagedFrame three_pixels() {
  StagedFrame frame;
  frame.title = "Frame 0";
  frame.amplitude = ImageF::Constant(1, 3, 4.0F);
  frame.wrapped_m = ImageF::Constant(1, 3, 2.0F);
  frame.unwrapped = RangeImage(1, 3);
  frame.unwrapped.range_m << 2, 7, 7;
  frame.unwrapped.wrap_count << 0, 1, 1;
  frame.unwrapped.confidence << 1, 0.5F, 0.5F;
  frame.unwrapped.reason << 0, 0, 0;
  frame.filtered = frame.unwrapped;
  frame.filtered.invalidate(0, 1, InvalidReason::jump_edge);
  return frame;
}

const Picture& panel(const StripFrame& frame, const std::string& caption) {
  for (const PageFigure& figure : frame.panels) {
    if (figure.caption == caption) return figure.picture;
  }
  ADD_FAILURE() << "no panel '" << caption << "'";
  return frame.panels.front().picture;
}

std::vector<std::string> captions(const std::vector<PageFigure>& figures) {
  std::vector<std::string> out;
  for (const PageFigure& figure : figures) out.push_back(figure.caption);
  return out;
}

TEST(FrameStrip, ShowsEveryStageOfAFrame) {
  const FrameStrip strip = frame_strip({three_pixels()}, 5);
  ASSERT_EQ(strip.frames.size(), 1U);
  const StripFrame& frame = strip.frames[0];
  EXPECT_EQ(frame.panels.size(), 6U);
  const ColorScale range(0, 7, "");
  EXPECT_EQ(panel(frame, "wrapped range, as measured").at(1, 0), range(2));
  EXPECT_EQ(panel(frame, "unwrapped range").at(1, 0), range(7));
  EXPECT_EQ(panel(frame, "wrap count").at(1, 0), wrap_count_color(1));
  EXPECT_EQ(panel(frame, "confidence of the wrap count").at(1, 0), ColorScale(0, 1, "")(0.5));
  const Picture& removed = panel(frame, "after filters, removed pixels by reason");
  EXPECT_EQ(removed.at(0, 0), range(2));
  EXPECT_EQ(removed.at(1, 0), reason_color(InvalidReason::jump_edge));
  EXPECT_THAT(frame.remark, HasSubstr("moved 66.7 % of them, filters removed 33.3 %"));
  EXPECT_THAT(captions(strip.legends), testing::Contains("reasons for removal"));
}

TEST(FrameStrip, ComparesWithTheTruthWhereItIsKnown) {
  StagedFrame frame = three_pixels();
  frame.truth_m.resize(1, 3);
  frame.truth_m << 2, 2, 7;  // the second is a wrap too far
  const FrameStrip strip = frame_strip({frame, three_pixels()}, 5);
  const Picture& wrong = panel(strip.frames[0], "wraps against the truth");
  EXPECT_EQ(wrong.at(0, 0), wrap_errors::none);
  EXPECT_EQ(wrong.at(1, 0), wrap_errors::too_far);
  EXPECT_EQ(strip.frames[1].panels.size(), 6U) << "the truth of this one is not known";
}

TEST(FrameStrip, RefusesImagesThatDifferInSize) {
  StagedFrame frame = three_pixels();
  frame.truth_m = ImageF::Zero(2, 3);
  EXPECT_THROW(frame_strip({frame}, 5), UsageError);
}

TEST(FrameStrip, DoesWithoutAmplitudeAndReturns) {
  StagedFrame frame;
  frame.wrapped_m = ImageF::Constant(1, 2, NAN);
  frame.unwrapped = frame.filtered = RangeImage(1, 2);
  const FrameStrip strip = frame_strip({frame}, 5);
  EXPECT_EQ(strip.frames[0].panels.size(), 5U);
  EXPECT_EQ(panel(strip.frames[0], "unwrapped range").at(0, 0), colors::invalid);
  EXPECT_THAT(strip.frames[0].remark, HasSubstr("0 pixels with a range"));
  EXPECT_TRUE(frame_strip({}, 5).frames.empty());
}

}  // namespace
}  // namespace tofmap
