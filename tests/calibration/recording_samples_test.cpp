// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/sample_frames.hpp"
#include "support/temporary_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/calibration/recording_samples.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using testing::ElementsAre;

/// Of the 35 pixels, two have no return at one of the frequencies, and one has no true range.
constexpr std::size_t usable_pixels = 32;

class RecordingSamplesTest : public testing::Test {
 protected:
  /// Frames with these indices of sample_frame(), so that equal indices give equal frames.
  SequenceReader record(const std::vector<int>& indices) const {
    SequenceWriter writer(folder_.path(), test::sample_sensor());
    double timestamp_s = 1;
    for (const int index : indices) {
      Frame frame = test::sample_frame(index);
      frame.timestamp_s = timestamp_s++;
      writer.add(frame);
    }
    return SequenceReader(folder_.path());
  }

  /// Every frame has the same reference; records the frames that it was called for.
  ReferenceRanges reference() {
    return [this](const Frame& frame) {
      asked_.push_back(frame.index);
      return std::make_optional(test::sample_range_truth());
    };
  }

  test::TemporaryFolder folder_;
  std::vector<int> asked_;
};

TEST_F(RecordingSamplesTest, AreTakenFromAllFrames) {
  const RecordingSamples found = collect_samples(record({0, 1, 2, 3}), reference(), 1);
  EXPECT_THAT(asked_, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(found.samples.front().size(), 4 * usable_pixels);
  EXPECT_EQ(found.frames, 4U);
  EXPECT_EQ(found.read, 4);
  EXPECT_EQ(found.first_frames.size(), 4U);
}

TEST_F(RecordingSamplesTest, AreTakenFromEveryNthFrame) {
  const RecordingSamples found = collect_samples(record({0, 1, 2, 3, 4, 5, 6}), reference(), 3);
  EXPECT_THAT(asked_, ElementsAre(0, 3, 6));
  EXPECT_THAT(found.frame_indices, ElementsAre(0, 3, 6));
  EXPECT_EQ(found.read, 3);
}

TEST_F(RecordingSamplesTest, LeaveOutFramesThatRepeatTheOneBefore) {
  const RecordingSamples found = collect_samples(record({0, 0, 1, 0, 0, 0}), reference(), 1);
  EXPECT_THAT(asked_, ElementsAre(0, 2, 3));
  EXPECT_EQ(found.repeated, 3U);
  EXPECT_EQ(found.frames, 3U);
  EXPECT_EQ(found.samples.front().size(), 3 * usable_pixels);
}

TEST_F(RecordingSamplesTest, CountDamagedFramesAndKeepTheFirstReason) {
  const SequenceReader recording = record({0, 1, 2});
  std::filesystem::resize_file(folder_.path() / "phase_a/000001.png", 10);
  std::filesystem::resize_file(folder_.path() / "phase_b/000002.png", 10);
  const RecordingSamples found = collect_samples(recording, reference(), 1);
  EXPECT_EQ(found.read, 3);
  EXPECT_EQ(found.damaged, 2);
  EXPECT_EQ(found.frames, 1U);
  EXPECT_THAT(found.first_damage, testing::HasSubstr("phase_a/000001.png"));
}

TEST_F(RecordingSamplesTest, LeaveOutFramesWithoutAReference) {
  const ReferenceRanges only_of_frame_1 = [](const Frame& frame) {
    return frame.index == 1 ? std::make_optional(test::sample_range_truth()) : std::nullopt;
  };
  const RecordingSamples found = collect_samples(record({0, 1, 2}), only_of_frame_1, 1);
  EXPECT_EQ(found.frames, 1U);
  ASSERT_EQ(found.first_frames.size(), 1U);
  EXPECT_EQ(found.first_frames[0].index, 1);
  EXPECT_THAT(found.frame_indices, ElementsAre(1));
}

TEST_F(RecordingSamplesTest, KeepTheFirstTwelveFrames) {
  std::vector<int> indices(14);
  std::iota(indices.begin(), indices.end(), 0);
  const RecordingSamples found = collect_samples(record(indices), reference(), 1);
  EXPECT_EQ(found.frames, 14U);
  ASSERT_EQ(found.first_frames.size(), 12U);
  EXPECT_EQ(found.first_frames.back().index, 11);
}

TEST_F(RecordingSamplesTest, NeedAStepOfAFrameAndReferencesOfTheImagesSize) {
  const SequenceReader recording = record({0, 1});
  EXPECT_THROW(collect_samples(recording, reference(), 0), UsageError);
  const ReferenceRanges too_small = [](const Frame&) {
    return std::make_optional<ImageF>(ImageF::Constant(4, 7, 1));
  };
  EXPECT_THROW(collect_samples(recording, too_small, 1), UsageError);
}

TEST_F(RecordingSamplesTest, EndWhenTheCallerWantsNoMore) {
  const RecordingSamples found =
      collect_samples(record({0, 1, 2, 3}), reference(), 1, [](int frame) { return frame < 2; });
  EXPECT_EQ(found.frames, 2U);
}

/// The recording of three frames that `folder` holds, with missing frames appended up to `frames`:
/// these count, but cannot be read.
void append_missing_frames(const std::filesystem::path& folder, int frames) {
  std::ofstream list(folder / "frames.txt", std::ios::app);
  for (int i = 3; i < frames; ++i) {
    list << i + 1
         << " phase_a/none.png phase_b/none.png amplitude_a/none.png amplitude_b/none.png\n";
  }
}

TEST_F(RecordingSamplesTest, AreSpreadOverThePixelsOfLongRecordings) {
  // 2 million samples are the limit: of 140000 frames of 35 pixels, every third pixel is used.
  record({0, 1, 2});
  append_missing_frames(folder_.path(), 140000);
  const RecordingSamples found = collect_samples(SequenceReader(folder_.path()), reference(), 1,
                                                 [](int frame) { return frame < 3; });
  ASSERT_EQ(found.frames, 3U);
  // Three frames with three first pixels use each pixel once.
  EXPECT_EQ(found.samples.front().size(), usable_pixels);
}

TEST_F(RecordingSamplesTest, AreSpreadOverThePixelsIfFramesAreLeftOutAsWell) {
  // Of 115000 frames every other is used: 57500 frames of 35 pixels, every second of them. With
  // the frame's index, the first pixel would always be an even one.
  record({0, 1, 2});
  append_missing_frames(folder_.path(), 115000);
  const RecordingSamples found = collect_samples(SequenceReader(folder_.path()), reference(), 2,
                                                 [](int frame) { return frame < 3; });
  ASSERT_EQ(found.frames, 2U);
  EXPECT_EQ(found.samples.front().size(), usable_pixels);
}

}  // namespace
}  // namespace tofmap
