// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

/// Maps a part of the path through a scene.
MapContent mapped(const test::Scenery& scene, int first, int end) {
  RoomMapper mapper(scene.camera(), {}, {}, {}, {});
  for (int i = first; i < end; ++i) mapper.add_frame({i, i / 15.0, scene.view(i), false});
  mapper.finish();
  return mapper.content();
}

/// A recording that goes on with a map.
class KnownMap : public testing::Test {
 protected:
  static constexpr int first = 100;
  static constexpr int end = 200;

  /// Goes on with the map of the frames `first` … `end` by other frames, in which there may be one
  /// more thing.
  RoomMapper going_on(const test::Scenery& scene, int from, int to, MapUse use,
                      std::optional<Eigen::AlignedBox3d> box = {}) const {
    RoomMapper mapper(room().camera(), {}, {}, {}, {});
    mapper.go_on_with(map(), {}, use);
    for (int i = from; i < to; ++i) {
      mapper.add_frame({i - from, (i - from) / 15.0, scene.view(i, box), false});
    }
    mapper.finish();
    return mapper;
  }

  /// Largest error of the poses of a recording that began at frame `from` of the scene, in the
  /// world of the map.
  double worst_error_m(const RoomMapper& mapper, int from) const {
    double worst_m = 0;
    const int map = maps_of(mapper.content()).front();
    for (const StampedPose& pose : trajectory_of(mapper.content(), map)) {
      const int frame = from + static_cast<int>(std::lround(15 * pose.timestamp_s));
      const Pose truth = room().pose(first).inverse() * room().pose(frame);
      worst_m =
          std::max(worst_m, (truth.translation() - pose.world_from_camera.translation()).norm());
    }
    return worst_m;
  }

  /// The room, and the map that all cases go on with.
  static const test::Scenery& room() {
    static const test::Scenery room("room");
    return room;
  }
  static const MapContent& map() {
    static const MapContent map = mapped(room(), first, end);
    return map;
  }
};

TEST_F(KnownMap, LocalisesACameraThatBeginsAnywhere) {
  for (const int from : {first + 5, first + 60}) {
    const RoomMapper mapper = going_on(room(), from, from + 30, MapUse::localise);
    EXPECT_EQ(mapper.localised_frames(), 30) << from;
    EXPECT_LT(worst_error_m(mapper, from), 0.01) << from;
  }
}

TEST_F(KnownMap, IsExtendedBeyondItsEnd) {
  const RoomMapper mapper = going_on(room(), end - 30, end + 40, MapUse::extend);
  EXPECT_EQ(mapper.localised_frames(), 70);
  EXPECT_LT(worst_error_m(mapper, end - 30), 0.01);
  EXPECT_GT(mapper.content().submaps.size(), map().submaps.size());
}

TEST_F(KnownMap, StaysAsItIsForALocalisedCamera) {
  const RoomMapper mapper = going_on(room(), first + 20, first + 60, MapUse::localise);
  for (const Keyframe& keyframe : map().keyframes.all()) {
    EXPECT_EQ(mapper.content().keyframes[keyframe.id].world_from_camera.matrix(),
              keyframe.world_from_camera.matrix())
        << keyframe.id;
  }
  for (std::size_t i = 0; i < map().submaps.size(); ++i) {
    EXPECT_EQ(mapper.content().submaps[i].surface.load()->to_bytes(),
              map().submaps[i].surface.load()->to_bytes());
  }
}

TEST_F(KnownMap, MayHaveSomethingNewInIt) {
  // A box of a metre in front of the camera's path.
  const Pose ahead = room().pose(first + 40);
  const Eigen::Vector3d middle = ahead * Eigen::Vector3d(0, 0, 2.5);
  const Eigen::AlignedBox3d box(middle - Eigen::Vector3d::Constant(0.4),
                                middle + Eigen::Vector3d::Constant(0.4));
  const RoomMapper mapper = going_on(room(), first + 10, first + 70, MapUse::localise, box);
  EXPECT_EQ(mapper.localised_frames(), 60);
  EXPECT_LT(worst_error_m(mapper, first + 10), 0.01);
}

TEST_F(KnownMap, TellsHowCertainPosesAre) {
  const RoomMapper mapper = going_on(room(), first + 5, first + 60, MapUse::localise);
  const auto covariances = covariances_of(mapper.content(), 0);
  ASSERT_EQ(covariances.size(), trajectory_of(mapper.content(), 0).size());
  for (const auto& covariance : covariances) {
    const double sigma_m = spread_of(covariance).translation_sigma_m();
    EXPECT_GT(sigma_m, 1e-5);
    EXPECT_LT(sigma_m, 0.02);
  }
}

TEST_F(KnownMap, IsEnteredWhereTheStartIs) {
  const auto localised_from = [&](const Pose& start) {
    RoomMapper mapper(room().camera(), {}, {}, {}, {});
    mapper.go_on_with(map(), {}, MapUse::localise, MapPlace{0, start});
    for (int i = 0; i < 30; ++i) {
      mapper.add_frame({i, i / 15.0, room().view(first + 20 + i), false});
    }
    mapper.finish();
    return mapper.localised_frames();
  };
  Pose start = room().pose(first).inverse() * room().pose(first + 20);
  EXPECT_EQ(localised_from(start), 30);
  Pose elsewhere = start;
  elsewhere.translation() += Eigen::Vector3d(3, 0, 0);
  EXPECT_EQ(localised_from(elsewhere), 0) << "another position";
  Pose turned = start;
  turned.rotate(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(localised_from(turned), 0) << "another direction";
}

TEST_F(KnownMap, DoesNotKnowAnotherPlace) {
  const test::Scenery other("flat");
  const RoomMapper mapper = going_on(other, 0, 60, MapUse::localise);
  EXPECT_EQ(mapper.localised_frames(), 0);
  EXPECT_GT(mapper.nearness().keyframes, 0);
  EXPECT_LT(mapper.nearness().agreeing, 3);
  EXPECT_FALSE(maps_of(mapper.content()).empty()) << "the recording is mapped by itself";
}

}  // namespace
}  // namespace tofmap
