// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/coverage.hpp"

#include <gtest/gtest.h>

namespace tofmap::app {
namespace {

/// A frame in a map, or in none (0), four frames a second.
FrameRecord frame(int index, int map) {
  FrameRecord record;
  record.index = index;
  record.timestamp_s = 10 + 0.25 * index;
  record.map = map;
  record.valid_pixels = 100;
  return record;
}

TEST(ToldIndices, AreStretches) {
  EXPECT_EQ(told_indices({}), "");
  EXPECT_EQ(told_indices({4}), "4");
  EXPECT_EQ(told_indices({4, 5, 6}), "4 to 6");
  EXPECT_EQ(told_indices({1, 4, 5, 9}), "1, 4 to 5 and 9");
  std::vector<int> many;
  for (int i = 0; i < 15; ++i) many.push_back(2 * i);
  EXPECT_EQ(told_indices(many), "0, 2, 4, 6, 8, 10, 12, 14, 16, 18 and 5 more");
}

TEST(AbsentFrames, HaveTheReasonThatExcludedThem) {
  RoomMap map;
  for (int i = 0; i < 7; ++i) map.frames.push_back(frame(i, 0));
  map.frames[0].map = 1;
  map.frames[1].damage = "phase_a/000001.png: is missing";
  map.frames[2].repeats = true;
  map.frames[3].valid_pixels = 0;
  map.frames[3].tracking.status = TrackingStatus::no_surface;
  map.frames[4].tracking.status = TrackingStatus::no_surface;
  std::vector<std::string> told;
  for (const AbsentFrames& absent : absent_frames(map)) {
    told.push_back(absent.why + ": " + told_indices(absent.indices));
  }
  EXPECT_EQ(told, (std::vector<std::string>{"damaged: 1", "repeating the frame before: 2",
                                            "without any range: 3", "with too little surface: 4",
                                            "not registered: 5 to 6"}));
}

TEST(SeparateMaps, SayWhenAndWhyTheyBegan) {
  RoomMap map;
  map.separate_maps.resize(2);
  for (int i = 0; i < 3; ++i) map.frames.push_back(frame(i, 1));
  for (int i = 3; i < 5; ++i) map.frames.push_back(frame(i, 2));
  map.frames.push_back(frame(5, 0));
  for (int i = 6; i < 8; ++i) map.frames.push_back(frame(i, 3));
  EXPECT_EQ(told_extent(map, 0), "frames 3 to 4, 0.75 to 1.00 s after the first frame");
  EXPECT_EQ(told_beginning(map, 0), "because frame 3 does not fit the frames before it");
  EXPECT_EQ(told_beginning(map, 1), "after 1 frame that is in no map");
  for (std::size_t i = 3; i < map.frames.size(); ++i) map.frames[i].timestamp_s += 2;
  EXPECT_EQ(told_beginning(map, 0), "after a gap of 2.25 s");
  for (std::size_t i = 6; i < map.frames.size(); ++i) map.frames[i].timestamp_s += 60;
  EXPECT_EQ(told_beginning(map, 1), "after 1 frame that is in no map and a gap of 60.50 s");
  for (FrameRecord& record : map.frames) record.timestamp_s = 4 * record.index;
  EXPECT_EQ(told_beginning(map, 0), "because frame 3 does not fit the frames before it");
}

TEST(SeparateMaps, MayHoldTheFirstFramesOfARecording) {
  RoomMap map;
  map.separate_maps.resize(1);
  map.frames = {frame(0, 2), frame(1, 1), frame(2, 1)};
  EXPECT_EQ(told_beginning(map, 0), "with the recording");
}

}  // namespace
}  // namespace tofmap::app
