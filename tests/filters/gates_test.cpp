// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/gates.hpp>

namespace tofmap {
namespace {

using test::plane;

TEST(AmplitudeFilter, JudgesByTheWeakerFrequency) {
  Frame frame = blank_frame(2);
  frame.amplitudes[0] = ImageF::Constant(16, 20, 100);
  frame.amplitudes[1] = ImageF::Constant(16, 20, 100);
  frame.amplitudes[1](2, 3) = 9;
  const RangeImage out = drop_low_amplitude(plane(3), frame, 10);
  EXPECT_EQ(out.count_valid(), 20 * 16 - 1);
  EXPECT_EQ(out.reason(2, 3), static_cast<int>(InvalidReason::low_amplitude));
}

TEST(AmplitudeFilter, DoesNothingWithoutAmplitudes) {
  EXPECT_EQ(drop_low_amplitude(plane(3), {}, 10).count_valid(), 20 * 16);
}

TEST(AmplitudeFilter, RefusesAFrameOfAnotherSize) {
  Frame frame = blank_frame(2);
  frame.amplitudes[0] = ImageF::Constant(16, 19, 100);
  frame.amplitudes[1] = ImageF::Constant(16, 19, 100);
  EXPECT_THROW(drop_low_amplitude(plane(3), frame, 10), UsageError);
}

TEST(ConfidenceFilter, KeepsWhatIsAsSureAsAskedFor) {
  RangeImage image = plane(3);
  image.confidence(2, 3) = 0.49F;
  image.confidence(4, 5) = 0.5F;
  const RangeImage out = drop_low_confidence(image, 0.5);
  EXPECT_EQ(out.reason(2, 3), static_cast<int>(InvalidReason::low_confidence));
  EXPECT_TRUE(out.valid(4, 5));
  EXPECT_EQ(out.count_valid(), 20 * 16 - 1);
}

}  // namespace
}  // namespace tofmap
