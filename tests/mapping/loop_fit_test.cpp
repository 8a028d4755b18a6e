// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/pose_circle.hpp"

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/loop_fit.hpp>

namespace tofmap {
namespace {

using test::along_x;
using test::circle;
using test::edge;
using test::largest_error_m;
using test::loop;

/// A camera that goes round a circle of 3 m, each step 5 mm too high, of which its edges, which
/// claim a millimetre, know nothing: in the end it is 12 cm off, of 18.8 m.
class DriftingPath : public testing::Test {
 protected:
  static constexpr int steps = 24;

  DriftingPath() {
    const Pose error = test::moved_by({0, 0, 0}, {0, 0, 0.005});
    Pose pose = truth_.front();
    for (int i = 0; i <= steps; ++i) {
      keyframes_.push_back({.id = i, .world_from_camera = pose, .path_m = 18.8 * i / steps});
      if (i == steps) break;
      const Pose motion = truth_[i].inverse() * truth_[i + 1] * error;
      edges_.push_back(edge(i, i + 1, motion, 0.001));
      pose = pose * motion;
    }
  }

  void add_right_loop(int from, int to) {
    edges_.push_back(loop(from, to, truth_[from].inverse() * truth_[to], 0.002));
  }

  /// As if the place of `from` had been seen elsewhere, so far ahead.
  void add_wrong_loop(int from, int to, double ahead_m) {
    const Pose motion =
        keyframes_[from].world_from_camera.inverse() * keyframes_[to].world_from_camera;
    edges_.push_back(loop(from, to, motion * along_x(ahead_m), 0.002));
  }

  double error_m() const {
    return largest_error_m(fit_loops(keyframes_, edges_, {}).poses, truth_);
  }

  int used_loops() const {
    const LoopFit fit = fit_loops(keyframes_, edges_, {});
    int used = 0;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].may_be_wrong && fit.is_used[i]) ++used;
    }
    return used;
  }

  std::vector<Pose> truth_ = circle(steps);
  std::vector<Keyframe> keyframes_;
  std::vector<PoseEdge> edges_;
};

TEST_F(DriftingPath, IsMendedByLoopsThatAgree) {
  const double before_m = error_m();
  EXPECT_GT(before_m, 0.08);
  add_right_loop(0, 23);
  add_right_loop(0, 24);
  add_right_loop(1, 24);
  EXPECT_LT(error_m(), 0.25 * before_m);
}

TEST_F(DriftingPath, IsNotBentByALoopAlone) {
  const double before_m = error_m();
  add_wrong_loop(0, 24, 0.3);
  EXPECT_LT(error_m(), before_m + 0.005);
}

TEST_F(DriftingPath, IsNotBentByLoopsThatDisagree) {
  const double before_m = error_m();
  add_wrong_loop(0, 22, 0.3);
  add_wrong_loop(0, 23, -0.25);
  add_wrong_loop(1, 24, 0.1);
  EXPECT_LT(error_m(), before_m + 0.01);
}

TEST_F(DriftingPath, IsMendedByMostLoops) {
  const double before_m = error_m();
  for (const int from : {0, 1, 2}) add_right_loop(from, 24);
  add_wrong_loop(0, 22, 0.4);
  EXPECT_LT(error_m(), 0.25 * before_m);
}

TEST_F(DriftingPath, IsNotMovedByTwoLoopsThatAgree) {
  // Two keyframes may be deceived by the same thing.
  const double before_m = error_m();
  add_wrong_loop(0, 23, 0.3);
  add_wrong_loop(0, 24, 0.3);
  EXPECT_LT(error_m(), before_m + 0.001);
  EXPECT_EQ(used_loops(), 0);
}

TEST_F(DriftingPath, UsesALoopThatAgreesWithIt) {
  add_wrong_loop(0, 24, 0.02);
  EXPECT_EQ(used_loops(), 1);
}

TEST_F(DriftingPath, UsesTheLoopsThatMendIt) {
  for (const int from : {0, 1, 2}) add_right_loop(from, 24);
  add_wrong_loop(0, 22, 0.4);
  EXPECT_EQ(used_loops(), 3);
}

TEST(LoopFit, OfNothingIsNothing) { EXPECT_TRUE(fit_loops({}, {}, {}).poses.empty()); }

}  // namespace
}  // namespace tofmap
