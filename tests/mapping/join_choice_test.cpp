// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_choice.hpp"

#include "support/scenery.hpp"
#include "tofmap/mapping/odometry.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// Two maps of one room, each by a recording of its own, that have not been joined.
class MapsOfOneRoom : public testing::Test {
 protected:
  static constexpr int begins[] = {100, 130};
  static constexpr int frames = 50;

  MapsOfOneRoom() {
    for (int map = 0; map < 2; ++map) add_map(map);
  }

  void add_map(int map) {
    RoomMapper mapper(room_.camera(), {}, {}, {}, {});
    for (int i = begins[map]; i < begins[map] + frames; ++i) {
      mapper.add_frame({i, i / 15.0, room_.view(i), false});
    }
    for (Keyframe keyframe : mapper.content().keyframes.all()) {
      keyframe.id = static_cast<int>(keyframes_.size());
      keyframe.map = map;
      keyframe.recording = map;
      keyframes_.push_back(std::move(keyframe));
    }
  }

  /// Recognitions, with an error, by the first `count` keyframes of the second map.
  std::vector<PoseEdge> recognitions(std::size_t count, const Eigen::Vector3d& error_m) const {
    std::vector<PoseEdge> edges;
    for (const Keyframe& keyframe : keyframes_) {
      if (keyframe.map == 0 || edges.size() >= count) continue;
      PoseEdge edge{.from = 3, .to = keyframe.id, .may_be_wrong = true};
      edge.from_from_to =
          room_.pose(keyframes_[3].frame_index).inverse() * room_.pose(keyframe.frame_index);
      edge.from_from_to.translation() += error_m;
      edge.covariance = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
      edges.push_back(edge);
    }
    return edges;
  }

  std::optional<MapJoin> find(const std::vector<PoseEdge>& edges, bool is_possible = true) const {
    return find_certain_join(1, edges, [&](const MapJoin&) { return is_possible; },
                             {keyframes_, room_.camera(), spacing_, loops_, registration_});
  }

  /// The choice while the second recording goes on.
  JoinChoice choose(const std::vector<PoseEdge>& edges) const {
    return choose_join(1, edges, edges, [](const MapJoin&) { return true; },
                       {keyframes_, room_.camera(), spacing_, loops_, registration_});
  }

  test::Scenery room_{"room"};
  KeyframeSpacing spacing_{OdometryOptions().keyframe_translation_m,
                           OdometryOptions().keyframe_rotation_rad};
  LoopOptions loops_;
  RegistrationOptions registration_;
  std::vector<Keyframe> keyframes_;
};

TEST_F(MapsOfOneRoom, AreJoinedWhereTwoKeyframesAgreeAndOthersConfirm) {
  const auto join = find(recognitions(2, {0, 0, 0}));
  ASSERT_TRUE(join);
  EXPECT_EQ(join->into, 0);
  EXPECT_EQ(join->map, 1);
  EXPECT_GT(join->edges.size(), 2U);
  const Pose truth = room_.pose(begins[0]).inverse() * room_.pose(begins[1]);
  EXPECT_LT((join->into_from_map.translation() - truth.translation()).norm(), 0.01);
}

TEST_F(MapsOfOneRoom, AreNotJoinedWhereOthersDoNotConfirm) {
  EXPECT_FALSE(find(recognitions(2, {1.5, 0, 0})));
}

TEST_F(MapsOfOneRoom, AreNotJoinedByOneKeyframe) { EXPECT_FALSE(find(recognitions(1, {0, 0, 0}))); }

TEST_F(MapsOfOneRoom, AreJoinedAtTheRightOneOfTwoPlaces) {
  std::vector<PoseEdge> edges = recognitions(3, {1.5, 0, 0});
  for (const PoseEdge& edge : recognitions(2, {0, 0, 0})) edges.push_back(edge);
  const auto join = find(edges);
  ASSERT_TRUE(join);
  const Pose truth = room_.pose(begins[0]).inverse() * room_.pose(begins[1]);
  EXPECT_LT((join->into_from_map.translation() - truth.translation()).norm(), 0.01);
}

TEST_F(MapsOfOneRoom, AwaitSixKeyframesThatAgreeWhileTheRecordingGoesOn) {
  ASSERT_EQ(recognitions(6, {0, 0, 0}).size(), 6U);
  const JoinChoice early = choose(recognitions(5, {0, 0, 0}));
  EXPECT_FALSE(early.join);
  EXPECT_EQ(early.obstacle, JoinObstacle::too_few);
  EXPECT_EQ(early.agreeing, 5);
  EXPECT_TRUE(choose(recognitions(6, {0, 0, 0})).join);
}

TEST_F(MapsOfOneRoom, AreNotJoinedWhereKeyframesAgreeButContradictThePlace) {
  const JoinChoice choice = choose(recognitions(6, {1.5, 0, 0}));
  EXPECT_FALSE(choice.join);
  EXPECT_EQ(choice.obstacle, JoinObstacle::contradicted);
}

TEST_F(MapsOfOneRoom, AreNotJoinedWhereTheCameraCannotHaveCome) {
  EXPECT_FALSE(find(recognitions(2, {0, 0, 0}), false));
}

}  // namespace
}  // namespace tofmap
