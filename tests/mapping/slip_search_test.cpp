// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/loop_fit.hpp>
#include <tofmap/mapping/slip_search.hpp>

namespace tofmap {
namespace {

using test::moved_by;

constexpr int keyframe_count = 12;
constexpr int slipped = 6;

/// A camera in a room whose odometry has gone wrong, and comes to a place that it has seen.
class SlipSearch : public testing::Test {
 protected:
  /// A keyframe every fifth frame; `error(id)` moves its pose.
  template <class Error>
  void walk(const Error& error) {
    for (int id = 0; id < keyframe_count; ++id) {
      const int frame = 100 + 5 * id;
      truth_.push_back(room_.pose(frame));
      keyframes_.push_back(
          {.id = id, .world_from_camera = error(id) * truth_.back(), .cloud = room_.view(frame)});
      for (int other = std::max(0, id - 3); other < id; ++other) add_edge(other, id);
    }
  }

  void add_edge(int from, int to) {
    PoseEdge edge;
    edge.from = from;
    edge.to = to;
    edge.from_from_to =
        keyframes_[from].world_from_camera.inverse() * keyframes_[to].world_from_camera;
    edge.covariance = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
    edges_.push_back(edge);
  }

  /// The loop that puts the last keyframe where `pose` is.
  PoseEdge loop_to(const Pose& pose) const {
    PoseEdge loop = edges_.back();
    loop.from = 0;
    loop.to = keyframe_count - 1;
    loop.from_from_to = keyframes_[0].world_from_camera.inverse() * pose;
    loop.may_be_wrong = true;
    return loop;
  }

  std::optional<Slip> find(const PoseEdge& loop) const {
    return find_slip(loop, keyframes_, edges_, room_.camera(), {}, {});
  }

  test::Scenery room_{"room"};
  std::vector<Pose> truth_;
  std::vector<Keyframe> keyframes_;
  std::vector<PoseEdge> edges_;
};

TEST_F(SlipSearch, FindsTheSlipThatOneLoopTellsOf) {
  const Pose slip = moved_by({0, 0, 0.01}, {0.12, -0.08, 0.02});
  walk([&](int id) { return id < slipped ? Pose::Identity() : slip; });
  const PoseEdge loop = loop_to(truth_.back());
  const auto found = find(loop);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->at, slipped);
  edges_.push_back(loop);
  const auto mended = without_slip(edges_, *found);
  const LoopFit fit = fit_loops(keyframes_, mended, {});
  for (int id = 0; id < keyframe_count; ++id) {
    const Pose error = truth_[id].inverse() * fit.poses[id];
    EXPECT_LT(error.translation().norm(), 0.01) << id;
  }
}

TEST_F(SlipSearch, FindsNoneThatWouldLeaveALaterKeyframeToALoop) {
  const Pose slip = moved_by({0, 0, 0.01}, {0.12, -0.08, 0.02});
  walk([&](int id) { return id < slipped ? Pose::Identity() : slip; });
  const PoseEdge loop = loop_to(truth_.back());
  // Of odometry, the last keyframe is registered with one from before the slip alone.
  std::erase_if(edges_, [](const PoseEdge& edge) { return edge.to == keyframe_count - 1; });
  add_edge(slipped - 1, keyframe_count - 1);
  add_edge(slipped, keyframe_count - 1);
  edges_.back().may_be_wrong = true;
  const auto found = find(loop);
  EXPECT_FALSE(found && found->at == slipped);
}

TEST_F(SlipSearch, FindsNoneWhereThePathHasDriftedBitByBit) {
  walk([](int id) { return moved_by({0, 0, 0}, {0.013 * id, 0, 0}); });
  EXPECT_FALSE(find(loop_to(truth_.back())));
}

TEST_F(SlipSearch, FindsNoneForALoopThatIsWrong) {
  walk([](int) { return Pose::Identity(); });
  EXPECT_FALSE(find(loop_to(moved_by({0, 0, 0}, {0.2, 0.1, 0}) * truth_.back())));
}

TEST_F(SlipSearch, TakesAnErrorThatRegistrationsLeaveForNoSlip) {
  walk([](int) { return Pose::Identity(); });
  EXPECT_FALSE(find(loop_to(moved_by({0, 0, 0}, {0.02, 0, 0}) * truth_.back())));
}

}  // namespace
}  // namespace tofmap
