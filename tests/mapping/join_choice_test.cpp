// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_choice.hpp"

#include "support/scenery.hpp"
#include "tofmap/mapping/odometry.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// Two maps of one room, each by a recording of its own, that have not been joined.
class MapsOfOneRoom : public testing::Test {
 protected:
  static constexpr int begins[] = {100, 130};
  static constexpr int frames = 50;
  static constexpr int map_alike = 2;

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

  /// Recognitions, with an error, of a keyframe of the first map by the first `count` keyframes of
  /// the second one.
  std::vector<PoseEdge> recognitions(std::size_t count, const Eigen::Vector3d& error_m,
                                     int from = 3) const {
    std::vector<PoseEdge> edges;
    for (const Keyframe& keyframe : keyframes_) {
      if (keyframe.map == 0 || edges.size() >= count) continue;
      PoseEdge edge{.from = from, .to = keyframe.id, .may_be_wrong = true};
      edge.from_from_to =
          room_.pose(keyframes_[static_cast<std::size_t>(from)].frame_index).inverse() *
          room_.pose(keyframe.frame_index);
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

  /// The choice while the second recording goes on, if all recognitions are sure.
  JoinChoice choose(const std::vector<PoseEdge>& edges) const { return choose(edges, edges); }

  JoinChoice choose(const std::vector<PoseEdge>& sure,
                    const std::vector<PoseEdge>& possible) const {
    return choose_join(1, sure, possible, [](const MapJoin&) { return true; },
                       {keyframes_, room_.camera(), spacing_, loops_, registration_});
  }

  /// What the second recording tells at its end of a join, whose place has an error.
  JoinReview review(const Eigen::Vector3d& error_m, const std::vector<PoseEdge>& possible) const {
    MapJoin join{.into = 0, .map = 1, .into_from_map = true_join(), .edges = {}};
    join.into_from_map.translation() += error_m;
    return review_join(
        join, possible, [](const MapJoin&) { return true; },
        {keyframes_, room_.camera(), spacing_, loops_, registration_}, least_agreeing_keyframes);
  }

  /// Adds a map of another room, which looks as the first one does.
  void add_room_alike() {
    const std::vector<Keyframe> before = keyframes_;
    for (Keyframe keyframe : before) {
      if (keyframe.map != 0) continue;
      keyframe.id = static_cast<int>(keyframes_.size());
      keyframe.map = map_alike;
      keyframes_.push_back(std::move(keyframe));
    }
  }

  /// The recognitions, and as many in the room that looks alike.
  std::vector<PoseEdge> recognitions_in_both(std::size_t count) const {
    std::vector<PoseEdge> edges = recognitions(count, {0, 0, 0});
    const auto alike = std::ranges::find(keyframes_, map_alike, &Keyframe::map);
    for (PoseEdge edge : recognitions(count, {0, 0, 0})) {
      edge.from += alike->id;
      edges.push_back(edge);
    }
    return edges;
  }

  Pose true_join() const { return room_.pose(begins[0]).inverse() * room_.pose(begins[1]); }

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
  EXPECT_LT((join->into_from_map.translation() - true_join().translation()).norm(), 0.01);
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
  EXPECT_LT((join->into_from_map.translation() - true_join().translation()).norm(), 0.01);
}

TEST_F(MapsOfOneRoom, AreJoinedEvenIfOneKeyframeRecognisesAWrongPlaceByManyOthers) {
  std::vector<PoseEdge> edges = recognitions(2, {0, 0, 0});
  for (const int from : {2, 3, 4}) {
    // Along the axes of the keyframe that it was recognised by: nearly the same place for all.
    edges.push_back(recognitions(1, {1.5, 0, 0}, from).front());
  }
  const auto join = find(edges);
  ASSERT_TRUE(join);
  EXPECT_LT((join->into_from_map.translation() - true_join().translation()).norm(), 0.01);
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

TEST_F(MapsOfOneRoom, AreJoinedAtAPlaceThatIsLessSureIfTheSureOneIsContradicted) {
  std::vector<PoseEdge> possible = recognitions(6, {1.5, 0, 0});
  for (const PoseEdge& edge : recognitions(6, {0, 0, 0})) possible.push_back(edge);
  const JoinChoice choice = choose(recognitions(6, {1.5, 0, 0}), possible);
  ASSERT_TRUE(choice.join);
  EXPECT_EQ(choice.obstacle, JoinObstacle::none);
  EXPECT_LT((choice.join->into_from_map.translation() - true_join().translation()).norm(), 0.01);
}

TEST_F(MapsOfOneRoom, AreNotJoinedWherePlacesLookAlike) {
  add_room_alike();
  const std::vector<PoseEdge> edges = recognitions_in_both(6);
  const JoinChoice choice = choose(edges);
  EXPECT_FALSE(choice.join);
  EXPECT_EQ(choice.obstacle, JoinObstacle::ambiguous);
  EXPECT_FALSE(find(edges));
}

TEST_F(MapsOfOneRoom, StayJoinedAtTheRightPlace) {
  std::vector<PoseEdge> edges = recognitions(2, {0, 0, 0});
  for (const PoseEdge& edge : recognitions(3, {1.5, 0, 0})) edges.push_back(edge);
  const JoinReview at_the_end = review({0, 0, 0}, edges);
  EXPECT_EQ(at_the_end.obstacle, JoinObstacle::none);
  EXPECT_FALSE(at_the_end.elsewhere);
}

TEST_F(MapsOfOneRoom, AreJoinedElsewhereIfLaterKeyframesShowThatThePlaceWasWrong) {
  std::vector<PoseEdge> edges = recognitions(3, {1.5, 0, 0});
  for (const PoseEdge& edge : recognitions(2, {0, 0, 0})) edges.push_back(edge);
  const JoinReview at_the_end = review({1.5, 0, 0}, edges);
  ASSERT_TRUE(at_the_end.elsewhere);
  EXPECT_LT((at_the_end.elsewhere->into_from_map.translation() - true_join().translation()).norm(),
            0.01);
}

TEST_F(MapsOfOneRoom, DoNotStayJoinedIfAllKeyframesFitElsewhereAsWell) {
  add_room_alike();
  const JoinReview at_the_end = review({0, 0, 0}, recognitions_in_both(3));
  EXPECT_EQ(at_the_end.obstacle, JoinObstacle::ambiguous);
  EXPECT_FALSE(at_the_end.elsewhere);
}

TEST_F(MapsOfOneRoom, StayJoinedIfFewKeyframesFitElsewhere) {
  add_room_alike();
  // Of the room that looks alike, the map has only a corner.
  std::erase_if(keyframes_, [](const Keyframe& keyframe) {
    return keyframe.map == map_alike && keyframe.frame_index > begins[0] + 20;
  });
  const JoinReview at_the_end = review({0, 0, 0}, recognitions_in_both(3));
  EXPECT_EQ(at_the_end.obstacle, JoinObstacle::none);
  EXPECT_FALSE(at_the_end.elsewhere);
}

TEST_F(MapsOfOneRoom, AreJoinedAtTheOneOfTwoPlacesAlikeWhereTheCameraCanHaveCome) {
  add_room_alike();
  const auto join = find_certain_join(
      1, recognitions_in_both(6), [](const MapJoin& place) { return place.into == map_alike; },
      {keyframes_, room_.camera(), spacing_, loops_, registration_});
  ASSERT_TRUE(join);
  EXPECT_EQ(join->into, map_alike);
}

TEST_F(MapsOfOneRoom, AreNotJoinedWhereTheCameraCannotHaveCome) {
  EXPECT_FALSE(find(recognitions(2, {0, 0, 0}), false));
}

}  // namespace
}  // namespace tofmap
