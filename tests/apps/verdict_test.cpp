// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "verdict.hpp"

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

/// As `map` gives it where the truth is not known and nothing is doubted.
Verdict verdict_without_truth(const RoomMap& map) {
  return verdict_on(map, "joint", std::nullopt, voxel_m, false);
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
  EXPECT_EQ(verdict_on(map, "joint", score_of_error(0.01), voxel_m, true), Verdict::doubtful);
  EXPECT_EQ(verdict_on(map, "none", score_of_error(0.01), voxel_m, false), Verdict::bad);
  EXPECT_EQ(verdict_on(map, "joint", score_of_error(1), voxel_m, false), Verdict::bad);
  map.interrupted = true;
  EXPECT_EQ(verdict_on(map, "joint", score_of_error(0.01), voxel_m, false), Verdict::doubtful);
  map.trajectory.clear();
  EXPECT_EQ(verdict_on(map, "joint", score_of_error(0.05), voxel_m, false), Verdict::bad);
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
