// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

using test::Scenery;

/// A camera that is followed, covered for a second, and seen again elsewhere.
class LostCamera : public testing::Test {
 protected:
  static constexpr int first = 100;
  static constexpr int frames = 60;

  LostCamera() : mapper_(room_.camera(), {}, {}, {}, {}) {
    for (int i = 0; i < frames; ++i) {
      EXPECT_TRUE(add(room_.view(first + i)).tracking.registered()) << i;
    }
    cover();
  }

  /// The camera is covered for a second.
  void cover() {
    const auto nothing = std::make_shared<const SurfaceCloud>();
    for (int i = 0; i < 15; ++i) EXPECT_FALSE(add(nothing).tracking.registered());
  }

  /// A box that stands in the room, where only later frames of its second visit see it.
  Eigen::AlignedBox3d box() const {
    const Eigen::Vector3d middle_m = room_.pose(first + 45) * Eigen::Vector3d(-2.35, 0, 3.6);
    const Eigen::Vector3d half_m = Eigen::Vector3d::Constant(0.25);
    return {middle_m - half_m, middle_m + half_m};
  }

  AddedFrame add(const std::shared_ptr<const SurfaceCloud>& cloud) {
    const int index = added_++;
    return mapper_.add_frame({index, index / 15.0, cloud});
  }

  Scenery room_{"room"};
  RoomMapper mapper_;
  int added_ = 0;
};

TEST_F(LostCamera, BeginsAMapThatIsJoinedWhereItRecognisesTheFirstOne) {
  // The camera comes back to its path near the beginning, where it was long before.
  const auto there = [&](int i) { return first + 6 + i; };
  EXPECT_FALSE(add(room_.view(there(0))).tracking.registered());
  EXPECT_FALSE(add(room_.view(there(1))).tracking.registered());
  const AddedFrame third = add(room_.view(there(2)));
  EXPECT_EQ(third.tracking.status, TrackingStatus::tracked);
  ASSERT_EQ(third.late.size(), 2U);
  EXPECT_EQ(third.late[0].tracking.status, TrackingStatus::first);
  EXPECT_EQ(third.late[1].tracking.status, TrackingStatus::tracked);
  EXPECT_EQ(third.late[1].index, added_ - 2);
  int relocalised = 0;
  for (int i = 3; i < 40; ++i) {
    const TrackingResult next = add(room_.view(there(i))).tracking;
    ASSERT_TRUE(next.registered()) << i;
    relocalised += next.status == TrackingStatus::relocalised ? 1 : 0;
  }
  EXPECT_EQ(relocalised, 1);
  mapper_.finish();
  EXPECT_EQ(mapper_.joins(), 1);
  EXPECT_EQ(mapper_.blind_joins(), 0);
  ASSERT_EQ(maps_of(mapper_.content()), std::vector{0});
  const Trajectory trajectory = trajectory_of(mapper_.content(), 0);
  ASSERT_EQ(trajectory.size(), frames + 40U) << "nothing that was seen is lost";
  for (int i = 0; i < 40; ++i) {
    const Pose truth = room_.pose(first).inverse() * room_.pose(there(i));
    const Pose& found = trajectory[static_cast<std::size_t>(frames + i)].world_from_camera;
    EXPECT_LT((truth.inverse() * found).translation().norm(), 0.02) << i;
  }
}

TEST_F(LostCamera, IsFoundByTheLookOfThePlaceAloneAfterThreeSeconds) {
  added_ += 45;
  for (int i = 0; i < 40; ++i) add(room_.view(first + 6 + i));
  mapper_.finish();
  EXPECT_EQ(mapper_.joins(), 1);
  EXPECT_EQ(mapper_.blind_joins(), 1);
}

TEST_F(LostCamera, IsTakenOutOfAMapThatLaterFramesDifferFrom) {
  // A room of the same plan, in which a box stands that only the later frames see.
  bool was_joined = false;
  for (int i = 0; i < 50; ++i) {
    const TrackingResult result = add(room_.view(first + 6 + i, box())).tracking;
    was_joined = was_joined || result.status == TrackingStatus::relocalised;
    EXPECT_TRUE(result.registered() || i < 2) << i;
  }
  mapper_.finish();
  EXPECT_TRUE(was_joined);
  EXPECT_EQ(mapper_.joins_taken_back(), 1);
  EXPECT_EQ(mapper_.joins(), 0);
  ASSERT_EQ(maps_of(mapper_.content()), (std::vector{0, 1}));
  EXPECT_EQ(trajectory_of(mapper_.content(), 0).size(), std::size_t{frames});
  const Trajectory apart = trajectory_of(mapper_.content(), 1);
  ASSERT_EQ(apart.size(), 50U);
  const Pose& begin = apart.front().world_from_camera;
  EXPECT_LT(begin.translation().norm(), 0.01) << "its first camera is its origin";
  const Pose truth = room_.pose(first + 6).inverse() * room_.pose(first + 55);
  const Pose error = truth.inverse() * begin.inverse() * apart.back().world_from_camera;
  EXPECT_LT(error.translation().norm(), 0.02);
  for (const PoseEdge& edge : mapper_.content().edges) {
    EXPECT_EQ(mapper_.content().keyframes.all()[edge.from].map,
              mapper_.content().keyframes.all()[edge.to].map);
  }
  EXPECT_LT(least_certain(certainties_of(mapper_.content(), 1)).error.position_m, 0.02)
      << "all its keyframes are connected";
}

TEST_F(LostCamera, KeepsAnEarlierJoinWhenALaterOneIsTakenBack) {
  for (int i = 0; i < 20; ++i) add(room_.view(first + 6 + i));
  ASSERT_EQ(mapper_.joins(), 1);
  cover();
  bool was_joined_again = false;
  for (int i = 0; i < 50; ++i) {
    add(room_.view(first + 6 + i, box()));
    was_joined_again = was_joined_again || mapper_.joins() == 2;
  }
  mapper_.finish();
  EXPECT_TRUE(was_joined_again);
  EXPECT_EQ(mapper_.joins(), 1);
  EXPECT_EQ(mapper_.joins_taken_back(), 1);
  ASSERT_EQ(maps_of(mapper_.content()), (std::vector{0, 2}));
  EXPECT_EQ(trajectory_of(mapper_.content(), 0).size(), frames + 20U);
  EXPECT_EQ(trajectory_of(mapper_.content(), 2).size(), 50U);
}

TEST_F(LostCamera, KeepsTheMapOfAnotherBuildingApart) {
  const Scenery flat("flat");
  RoomMapper alone(flat.camera(), {}, {}, {}, {});
  constexpr int frames_there = 40;
  for (int i = 0; i < frames_there; ++i) {
    const auto view = flat.view(50 + i);
    add(view);
    alone.add_frame({i, i / 15.0, view});
  }
  mapper_.finish();
  alone.finish();
  ASSERT_EQ(maps_of(mapper_.content()), (std::vector{0, 1}));
  EXPECT_EQ(trajectory_of(mapper_.content(), 0).size(), std::size_t{frames});
  const Trajectory there = trajectory_of(mapper_.content(), 1);
  const Trajectory expected = trajectory_of(alone.content(), 0);
  ASSERT_EQ(there.size(), std::size_t{frames_there});
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_TRUE(there[i].world_from_camera.isApprox(expected[i].world_from_camera, 1e-9)) << i;
  }
  EXPECT_EQ(surface_of(mapper_.content(), 1).size(), surface_of(alone.content(), 0).size());
}

TEST_F(LostCamera, BeginsNoMapWhileItIsCovered) {
  const auto nothing = std::make_shared<const SurfaceCloud>();
  for (int i = 0; i < 20; ++i) {
    const AddedFrame covered = add(nothing);
    EXPECT_EQ(covered.tracking.status, TrackingStatus::no_surface) << i;
    EXPECT_TRUE(covered.late.empty()) << i;
  }
}

TEST_F(LostCamera, DropsWhatPassesInFrontOfIt) {
  // Three frames that have nothing to do with each other, three times over.
  const Scenery flat("flat");
  for (const int start : {20, 100, 180}) {
    for (int i = 0; i < 3; ++i) add(flat.view(start + 25 * i));
  }
  EXPECT_LE(maps_of(mapper_.content()).size(), 2U);
}

TEST_F(LostCamera, IsFoundAfterAnInterruptionAsWithoutOne) {
  // Interrupted while frames are held, while there are two maps, and after these were joined.
  const auto there = [&](int i) { return first + 6 + i; };
  std::vector<std::unique_ptr<RoomMapper>> resumed;
  std::vector<std::size_t> maps;
  for (int i = 0; i < 40; ++i) {
    if (i == 2 || i == 5 || i == 30) {
      maps.push_back(maps_of(mapper_.content()).size());
      resumed.push_back(std::make_unique<RoomMapper>(room_.camera(), OdometryOptions(),
                                                     RegistrationOptions(), LoopOptions(),
                                                     SurfaceMapOptions()));
      resumed.back()->restore(mapper_.content(), mapper_.state(), added_);
    }
    const auto view = room_.view(there(i));
    for (const auto& mapper : resumed) mapper->add_frame({added_, added_ / 15.0, view});
    add(view);
  }
  ASSERT_EQ(maps, (std::vector<std::size_t>{1, 2, 1}));
  mapper_.finish();
  const Trajectory expected = trajectory_of(mapper_.content(), 0);
  for (const auto& mapper : resumed) {
    mapper->finish();
    EXPECT_EQ(mapper->joins(), 1);
    const Trajectory found = trajectory_of(mapper->content(), 0);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].world_from_camera.matrix(), expected[i].world_from_camera.matrix()) << i;
    }
  }
}

TEST(CameraAfterAGap, IsFollowedOn) {
  constexpr int first = 100;
  const Scenery room("room");
  for (const int gap : {6, 10, 15}) {
    RoomMapper mapper(room.camera(), {}, {}, {}, {});
    for (int i = 0; i < 60; ++i) {
      if (i >= 30 && i < 30 + gap) continue;
      EXPECT_TRUE(mapper.add_frame({i, i / 15.0, room.view(first + i)}).tracking.registered()) << i;
    }
    const Pose truth = room.pose(first).inverse() * room.pose(first + 59);
    const Pose found = trajectory_of(mapper.content(), 0).back().world_from_camera;
    EXPECT_LT((truth.inverse() * found).translation().norm(), 0.02) << gap;
  }
}

}  // namespace
}  // namespace tofmap
