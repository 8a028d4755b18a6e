// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/sampled_frames.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace tofmap::app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Frames with an index each, of which every fifth is damaged.
class CountedFrames final : public FrameSource {
 public:
  explicit CountedFrames(int total, int width_px = 4) : total_(total) {
    sensor_.camera.width_px = width_px;
    sensor_.camera.height_px = 4;
  }

  const SensorModel& sensor() const override { return sensor_; }

  std::optional<SourcedFrame> next() override {
    if (next_ == total_) return std::nullopt;
    SourcedFrame sourced;
    if (next_ % 5 == 4) {
      sourced.damage = "cut off";
    } else {
      sourced.frame.emplace();
      sourced.frame->index = next_;
    }
    ++next_;
    return sourced;
  }

  std::optional<int> frame_count() const override { return total_; }

 private:
  SensorModel sensor_;
  int total_;
  int next_ = 0;
};

std::vector<int> kept_of(int total, int wanted, int width_px = 4) {
  CountedFrames source(total, width_px);
  SamplingSource sampling(source, wanted);
  int passed = 0;
  while (sampling.next()) ++passed;
  EXPECT_EQ(passed, total) << "damaged ones are passed on, too";
  std::vector<int> indices;
  for (const DualFrequencyFrame& frame : sampling.kept()) indices.push_back(frame.index);
  return indices;
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

TEST(SamplingSource, KeepsAllOfAFew) { EXPECT_THAT(kept_of(4, 3), ElementsAre(0, 1, 2, 3)); }

TEST(SamplingSource, KeepsAtLeastWhatIsWantedSpreadOverAll) {
  for (const int total : {20, 57, 100, 1000}) {
    const std::vector<int> kept = kept_of(total, 8);
    EXPECT_GE(kept.size(), 8U) << total;
    EXPECT_LT(kept.size(), 16U) << total;
    EXPECT_EQ(kept.front(), 0);
    const int step = kept[1] - kept[0];
    for (std::size_t i = 1; i < kept.size(); ++i) {
      EXPECT_NEAR(kept[i] - kept[i - 1], step, 2) << "damaged ones lie between, of " << total;
    }
    EXPECT_GE(kept.back() + 2 * step, total) << total;
  }
}

TEST(SamplingSource, KeepsFewerOfLargeImages) {
  constexpr int width_px = 2 << 20;  // 128 MB a frame
  EXPECT_THAT(kept_of(40, 8, width_px), testing::SizeIs(testing::Lt(3)));
}

}  // namespace
}  // namespace tofmap::app
