// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/frame_sample.hpp"

#include "support/stored_map.hpp"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>

namespace tofmap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

CameraModel camera_of(int width_px) {
  CameraModel camera;
  camera.width_px = width_px;
  camera.height_px = 4;
  return camera;
}

/// Adds frames of these indices without returns, of four rows and columns.
void add(FrameSample& sample, const std::vector<int>& indices) {
  PreparedFrame prepared;
  prepared.returns = blank_frame(2);
  prepared.unwrapped.image = prepared.filtered.image = RangeImage(4, 4);
  for (const int index : indices) {
    Frame frame = blank_frame(2);
    frame.index = index;
    sample.add(frame, prepared);
  }
}

std::vector<int> up_to(int total) {
  std::vector<int> indices(static_cast<std::size_t>(total));
  for (int i = 0; i < total; ++i) indices[static_cast<std::size_t>(i)] = i;
  return indices;
}

std::vector<int> indices_of(const FrameSample& sample) {
  std::vector<int> indices;
  for (const SampledFrame& frame : sample.frames()) indices.push_back(frame.recorded.index);
  return indices;
}

/// What is kept of a run whose length nobody knows.
std::vector<int> kept_of(int total, int wanted, int width_px = 4) {
  FrameSample sample(camera_of(width_px), wanted, std::nullopt);
  add(sample, up_to(total));
  return indices_of(sample);
}

TEST(FrameSample, DropsTheRangesOfWhatMovesInAFrame) {
  const CameraModel camera = camera_of(4);
  FrameSample sample(camera, 2, 2);
  PreparedFrame prepared;
  prepared.filtered.image = RangeImage(camera.height_px, camera.width_px);
  prepared.filtered.image.range_m.setConstant(2);
  prepared.filtered.image.reason.setZero();
  for (const int index : {0, 1}) {
    Frame frame = blank_frame(2);
    frame.index = index;
    sample.add(frame, prepared);
  }
  SurfacePoint there{};
  there.getVector3fMap().setConstant(1);
  there.confidence = 1;
  SurfacePoint moving = there;
  moving.confidence = moving_confidence;
  SurfaceCloud still(4, 4, there);
  still.at(3, 1) = moving;
  sample.drop_moving(1, still);
  sample.drop_moving(7, still);
  const auto valid = [&](int frame) {
    return sample.frames()[static_cast<std::size_t>(frame)].filtered.range_m.array().isFinite();
  };
  EXPECT_EQ(valid(0).count(), 16);
  EXPECT_EQ(valid(1).count(), 15);
  EXPECT_EQ(sample.frames()[1].filtered.reason(1, 3),
            static_cast<int>(InvalidReason::free_space_violation));
}

TEST(SpreadIndices, LieInTheMiddlesOfEqualParts) {
  EXPECT_THAT(spread_indices(9, 3), ElementsAre(1, 4, 7));
  EXPECT_THAT(spread_indices(3, 9), ElementsAre(0, 1, 2)) << "no more than there are";
  EXPECT_THAT(spread_indices(0, 9), IsEmpty());
  EXPECT_THAT(spread_indices(9, 0), IsEmpty());
}

TEST(SpreadIndices, OfTheLongestRecordingsStayWithin) {
  constexpr int total = std::numeric_limits<int>::max();
  const std::vector<int> indices = spread_indices(total, 1000);
  EXPECT_TRUE(std::ranges::is_sorted(indices));
  EXPECT_GE(indices.front(), 0);
  EXPECT_GT(indices.back(), total - total / 1000);
}

TEST(FrameSample, IsTheSameAfterItWasPutAside) {
  const CameraModel camera = camera_of(4);
  FrameSample sample(camera, 3, 9);
  Frame frame = blank_frame(2);
  frame.index = 1;
  frame.phases[0] = ImageF::Constant(camera.height_px, camera.width_px, 0.25F);
  PreparedFrame prepared;
  prepared.unwrapped.image = RangeImage(camera.height_px, camera.width_px);
  prepared.unwrapped.curl_violations = 7;
  prepared.unwrapped.converged = false;
  prepared.filtered.image = prepared.unwrapped.image;
  prepared.filtered.image.reason(1, 2) = 8;
  prepared.returns = frame;
  sample.add(frame, prepared);
  const test::StoredMap aside;
  aside.save(sample);

  FrameSample resumed(camera, 3, 9);
  resumed.load(aside.store(), 2);
  add(resumed, {2, 3, 4, 5, 6, 7, 8});
  ASSERT_THAT(indices_of(resumed), ElementsAre(1, 4, 7));
  const SampledFrame& first = resumed.frames().front();
  EXPECT_TRUE(same_values(first.recorded.phases[0], frame.phases[0]));
  EXPECT_EQ(first.unwrapped.curl_violations, 7);
  EXPECT_EQ(first.unwrapped.converged, false);
  EXPECT_TRUE((first.filtered.reason == prepared.filtered.image.reason).all());
}

TEST(FrameSample, ThatWantsFewerFramesLoadsFewer) {
  const CameraModel camera = camera_of(4);
  FrameSample sample(camera, 20, 20);
  add(sample, up_to(10));
  const test::StoredMap aside;
  aside.save(sample);
  FrameSample resumed(camera, 4, 20);
  resumed.load(aside.store(), 10);
  EXPECT_THAT(indices_of(resumed), ElementsAre(2, 7)) << "two of the four are to come";
}

TEST(FrameSample, OfKnownLengthKeepsFramesSpreadOverTheRun) {
  FrameSample sample(camera_of(4), 3, 9);
  add(sample, up_to(9));
  EXPECT_THAT(indices_of(sample), ElementsAre(1, 4, 7));
  EXPECT_TRUE(sample.wants(4));
  EXPECT_FALSE(sample.wants(5));
}

TEST(FrameSample, OfUnknownLengthKeepsAllOfAFew) {
  EXPECT_THAT(kept_of(4, 3), ElementsAre(0, 1, 2, 3));
}

TEST(FrameSample, OfUnknownLengthKeepsAtLeastWhatIsWantedSpreadEvenly) {
  for (const int total : {20, 57, 100, 1000}) {
    const std::vector<int> kept = kept_of(total, 8);
    EXPECT_GE(kept.size(), 8U) << total;
    EXPECT_LT(kept.size(), 16U) << total;
    EXPECT_EQ(kept.front(), 0);
    const int step = kept[1] - kept[0];
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_EQ(kept[i] - kept[i - 1], step) << total;
    EXPECT_GE(kept.back() + 2 * step, total) << total;
  }
}

TEST(FrameSample, KeepsFewerOfLargeImages) {
  constexpr int width_px = 2 << 20;  // 416 MB a frame
  EXPECT_THAT(kept_of(40, 8, width_px), testing::SizeIs(testing::Lt(3)));
  FrameSample sample(camera_of(width_px), 8, 40);
  add(sample, up_to(40));
  EXPECT_THAT(sample.frames(), testing::SizeIs(1));
}

TEST(FrameSample, IsThinnedOutEvenly) {
  FrameSample sample(camera_of(4), 9, 9);
  add(sample, up_to(9));
  sample.thin_out(3);
  EXPECT_THAT(indices_of(sample), ElementsAre(1, 4, 7));
  sample.thin_out(5);
  EXPECT_THAT(indices_of(sample), ElementsAre(1, 4, 7)) << "there are no more";
}

}  // namespace
}  // namespace tofmap
