// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/verdict.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {
namespace {

constexpr double voxel_m = 0.04;

/// A map of 100 frames with a point, all of them placed.
RoomMap good_map() {
  RoomMap map;
  map.surface.push_back(MapPoint());
  map.frames.resize(100);
  map.trajectory.resize(100);
  return map;
}

MapScore score_of_error(double accuracy_m) {
  MapScore score;
  score.accuracy_m = accuracy_m;
  return score;
}

/// As `map` has it where the truth is not known and nothing is doubted.
MapEvidence evidence_of(const RoomMap& map) {
  return {.map = map, .method = "joint", .score = std::nullopt, .voxel_m = voxel_m};
}

Verdict verdict_without_truth(const RoomMap& map) { return judge(evidence_of(map)).verdict; }

Verdict verdict_with_error(const RoomMap& map, double accuracy_m) {
  MapEvidence evidence = evidence_of(map);
  evidence.score = score_of_error(accuracy_m);
  return judge(evidence).verdict;
}

TEST(Verdict, GoesByTheMapErrorInVoxels) {
  EXPECT_EQ(verdict_on(score_of_error(0.04), voxel_m), Verdict::good);
  EXPECT_EQ(verdict_on(score_of_error(0.041), voxel_m), Verdict::doubtful);
  EXPECT_EQ(verdict_on(score_of_error(0.2), voxel_m), Verdict::doubtful);
  EXPECT_EQ(verdict_on(score_of_error(0.201), voxel_m), Verdict::bad);
  EXPECT_EQ(verdict_on(score_of_error(NAN), voxel_m), Verdict::bad) << "an empty map";
}

TEST(Verdict, GoesByTheFramesThatWerePlaced) {
  RoomMap map = good_map();
  EXPECT_EQ(verdict_without_truth(map), Verdict::good);
  map.trajectory.resize(95);
  EXPECT_EQ(verdict_without_truth(map), Verdict::good);
  map.trajectory.resize(94);
  EXPECT_EQ(verdict_without_truth(map), Verdict::doubtful);
  map.trajectory.resize(49);
  EXPECT_EQ(verdict_without_truth(map), Verdict::bad);
  EXPECT_EQ(verdict_without_truth({}), Verdict::bad) << "nothing at all";
}

TEST(Verdict, GoesByDirectionsThatNoSurfaceHeld) {
  RoomMap map = good_map();
  for (std::size_t i = 0; i < 11; ++i) {
    if (i == 10) {
      EXPECT_EQ(verdict_without_truth(map), Verdict::good);
    }
    map.frames[i].tracking.registration.degenerate_directions = 1;
  }
  EXPECT_EQ(verdict_without_truth(map), Verdict::doubtful);
}

TEST(Verdict, IsTheWorstOfAllThatIsKnown) {
  RoomMap map = good_map();
  EXPECT_EQ(verdict_with_error(map, 0.01), Verdict::good);
  EXPECT_EQ(verdict_with_error(map, 1), Verdict::bad);
  MapEvidence evidence = evidence_of(map);
  evidence.score = score_of_error(0.05);
  evidence.method = "none";
  EXPECT_EQ(judge(evidence).verdict, Verdict::bad);
  map.interrupted = true;
  EXPECT_EQ(verdict_with_error(map, 0.01), Verdict::doubtful);
  map.trajectory.clear();
  EXPECT_EQ(verdict_with_error(map, 0.05), Verdict::bad);
}

TEST(Verdict, IsNoBetterThanWhatCouldBeChecked) {
  const RoomMap map = good_map();
  MapEvidence evidence = evidence_of(map);
  evidence.is_seen_twice = false;
  EXPECT_EQ(judge(evidence).verdict, Verdict::doubtful);
  evidence.is_seen_twice = true;
  evidence.is_warned = true;
  EXPECT_EQ(judge(evidence).verdict, Verdict::doubtful);
}

TEST(Verdict, TellsItsReasons) {
  RoomMap map = good_map();
  EXPECT_EQ(told_reasons(judge(evidence_of(map))), "");
  map.trajectory.resize(90);
  map.interrupted = true;
  EXPECT_EQ(told_reasons(judge(evidence_of(map))),
            " Held against it: 10 % of the frames could not be placed; the run was interrupted.");
}

TEST(Verdict, OnRangesGoesByWrongWraps) {
  EXPECT_EQ(verdict_on_wraps(2), Verdict::good);
  EXPECT_EQ(verdict_on_wraps(2.1), Verdict::doubtful);
  EXPECT_EQ(verdict_on_wraps(10), Verdict::doubtful);
  EXPECT_EQ(verdict_on_wraps(10.1), Verdict::bad);
  EXPECT_EQ(verdict_on_wraps(NAN), Verdict::doubtful) << "not known";
}

}  // namespace
}  // namespace tofmap::app
