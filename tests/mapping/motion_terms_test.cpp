// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "motion_terms.hpp"

#include "support/box_room.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// 60 frames of one keyframe, which go sideways by 2 cm from frame to frame and are certain but for
/// frame 30.
class OneUncertainFrame : public testing::Test {
 protected:
  OneUncertainFrame() {
    content_.recordings.emplace_back();
    content_.keyframes.add({.id = 0,
                            .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                                test::small_camera(), {-1, -1, -1}, {1, 1, 2}, Pose::Identity()))});
    for (int i = 0; i < 60; ++i) {
      RegisteredFrame& frame = content_.frames.emplace_back();
      frame.timestamp_s = i / 15.0;
      frame.index = i;
      frame.keyframe_from_camera.translation().x() = 0.02 * i;
    }
    content_.frames[30].covariance(3, 3) = 1;
  }

  std::vector<MotionTerm> terms() const {
    return motion_terms(content_, 0, MotionUncertainty(0.03, 0.03));
  }

  MapContent content_{test::small_camera(), {}};
};

TEST_F(OneUncertainFrame, HasTermsAroundIt) {
  const std::vector<MotionTerm> found = terms();
  // Those with a frame at most five frames before or after it.
  ASSERT_EQ(found.size(), 13U);
  EXPECT_EQ(found.front().frames, (std::array<std::size_t, 3>{23, 24, 25}));
  EXPECT_EQ(found.back().frames, (std::array<std::size_t, 3>{35, 36, 37}));
  for (const MotionTerm& term : found) {
    EXPECT_NEAR(term.share, 1, 1e-9);
    EXPECT_LT(term.change.norm(), 1e-9);
  }
}

TEST_F(OneUncertainFrame, IsExpectedWhereConstantVelocityPutsIt) {
  // Half a period after the frame before it, and 3 cm beyond.
  content_.frames[30].timestamp_s -= 0.5 / 15;
  content_.frames[30].keyframe_from_camera.translation().x() += 0.02;
  const MotionTerm term = terms()[5];
  ASSERT_EQ(term.frames.back(), 30U);
  EXPECT_NEAR(term.share, 0.5, 1e-9);
  EXPECT_NEAR(term.change[3], 0.03, 1e-9);
}

TEST_F(OneUncertainFrame, MayHaveChangedItsMotionInAGap) {
  for (std::size_t i = 31; i < content_.frames.size(); ++i) content_.frames[i].timestamp_s += 2;
  const std::vector<MotionTerm> found = terms();
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back().frames.back(), 30U);
}

TEST_F(OneUncertainFrame, HasNoneInAnotherRecording) {
  content_.recordings.emplace_back();
  EXPECT_TRUE(motion_terms(content_, 1, MotionUncertainty(0.03, 0.03)).empty());
}

TEST_F(OneUncertainFrame, MayBeMoreCertainThanUnsteadyMotion) {
  // By frame 55, the motion is known to be steady to 2 cm, but not if it is not.
  content_.frames[30].covariance.setZero();
  content_.frames[55].covariance(3, 3) = 0.02 * 0.02;
  EXPECT_FALSE(terms().empty());
  for (std::size_t i = 0; i < content_.frames.size(); i += 2) {
    content_.frames[i].keyframe_from_camera.translation().y() = 0.1;
  }
  EXPECT_TRUE(terms().empty());
}

}  // namespace
}  // namespace tofmap
