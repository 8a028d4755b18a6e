// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

RangeImage valid_image() {
  RangeImage image(3, 4);
  image.range_m.setConstant(7);
  image.sigma_m.setConstant(0.02F);
  image.wrap_count.setConstant(1);
  image.confidence.setConstant(0.8F);
  image.reason.setZero();
  return image;
}

TEST(RangeImage, BeginsWithoutAnyReturn) {
  const RangeImage image(3, 4);
  EXPECT_EQ(image.rows(), 3);
  EXPECT_EQ(image.cols(), 4);
  EXPECT_EQ(image.count_valid(), 0);
  EXPECT_EQ(count_reason(image, InvalidReason::no_return), 12);
  EXPECT_TRUE(image.range_m.isNaN().all());
  EXPECT_TRUE(image.sigma_m.isNaN().all());
  EXPECT_TRUE((image.wrap_count == invalid_wrap_count).all());
  EXPECT_TRUE((image.confidence == 0).all());
}

TEST(RangeImage, IsInvalidInAllPlanesAtOnce) {
  RangeImage image = valid_image();
  ASSERT_EQ(image.count_valid(), 12);
  image.invalidate(1, 2, InvalidReason::jump_edge);
  EXPECT_FALSE(image.valid(1, 2));
  EXPECT_TRUE(std::isnan(image.range_m(1, 2)));
  EXPECT_TRUE(std::isnan(image.sigma_m(1, 2)));
  EXPECT_EQ(image.wrap_count(1, 2), invalid_wrap_count);
  EXPECT_EQ(image.confidence(1, 2), 0);
  EXPECT_EQ(image.reason(1, 2), 4);
  EXPECT_EQ(image.count_valid(), 11);
  EXPECT_EQ(count_reason(image, InvalidReason::jump_edge), 1);
  EXPECT_EQ(image.range_m(1, 1), 7);
}

TEST(InvalidReason, HasTheNumbersThatFilesHold) {
  // reason/NNNNNN.png is read by others: numbers and names stay.
  const std::vector<std::string> names{"none",
                                       "no_return",
                                       "low_amplitude",
                                       "low_confidence",
                                       "jump_edge",
                                       "out_of_range",
                                       "ambiguous",
                                       "saturated",
                                       "isolated_wrap",
                                       "outlier",
                                       "free_space_violation",
                                       "unknown"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(reason_name(static_cast<InvalidReason>(i)), names[i]);
  }
}

}  // namespace
}  // namespace tofmap
