// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/change_detection.hpp"

#include "seen_surface.hpp"
#include "support/scenery.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

using Box = Eigen::AlignedBox3d;

/// Two recordings of a room, in one of which, or both, a box stands in front of the camera.
class FurnitureOnTheMove : public testing::Test {
 protected:
  static constexpr int first = 100;
  static constexpr int end = 160;

  /// A box of 0.8 m, away from the walls, displaced to the right as the camera sees it.
  Box box(double right_m) const {
    const Pose ahead = room_.pose(first + 30);
    const Eigen::Vector3d middle = ahead * Eigen::Vector3d(right_m, 0, 2.5);
    return {middle - Eigen::Vector3d::Constant(0.4), middle + Eigen::Vector3d::Constant(0.4)};
  }

  /// The map of two recordings with these boxes.
  MapContent mapped(const std::optional<Box>& before, const std::optional<Box>& after) const {
    RoomMapper one(room_.camera(), {}, {}, {}, {});
    add_frames(before, one);
    RoomMapper both(room_.camera(), {}, {}, {}, {});
    both.go_on_with(one.content(), {}, MapUse::extend);
    add_frames(after, both);
    EXPECT_EQ(both.localised_frames(), end - first);
    return both.content();
  }

  /// The share of points that are on a box of the scene.
  double share_on(const Box& box, const MapCloud& points) const {
    const Pose scene_from_map = room_.pose(first);
    const double near_m = 1.5 * SurfaceMapOptions().voxel_m;
    const auto on_box = std::ranges::count_if(points, [&](const MapPoint& point) {
      return box.exteriorDistance(scene_from_map * point.getVector3fMap().cast<double>()) < near_m;
    });
    return static_cast<double>(on_box) / static_cast<double>(points.size());
  }

 private:
  void add_frames(const std::optional<Box>& box, RoomMapper& mapper) const {
    for (int i = first; i < end; ++i) {
      mapper.add_frame({i - first, (i - first) / 15.0, room_.view(i, box), false});
    }
    mapper.finish();
  }

  test::Scenery room_{"room"};
};

TEST_F(FurnitureOnTheMove, IsSeenToBeGone) {
  const MapContent content = mapped(box(0), std::nullopt);
  ASSERT_EQ(content.changes.size(), 1);
  const MapChange& change = content.changes.front();
  EXPECT_EQ(change.kind, ChangeKind::gone);
  EXPECT_EQ(change.recording, 1);
  EXPECT_TRUE(change.after.empty());
  EXPECT_GT(change.before.size(), 200);
  EXPECT_GT(share_on(box(0), change.before), 0.95);
  EXPECT_LT(share_on(box(0), surface_of(content, change.map)), 0.001) << "the map shows what is";
}

TEST_F(FurnitureOnTheMove, IsInTheSurfaceOfTheRecordingThatSawIt) {
  const MapContent content = mapped(box(0), std::nullopt);
  const SeenSurface before = surface_seen(content, 0, 0, 1);
  const SeenSurface after = surface_seen(content, 0, 1, 2);
  EXPECT_TRUE(std::ranges::all_of(before.keyframes,
                                  [](const Keyframe& one) { return one.recording == 0; }));
  EXPECT_TRUE(
      std::ranges::all_of(after.keyframes, [](const Keyframe& one) { return one.recording == 1; }));
  EXPECT_GT(share_on(box(0), before.points), 0.01);
  EXPECT_LT(share_on(box(0), after.points), 0.001);
  EXPECT_GT(after.points.size(), 1000);
}

TEST_F(FurnitureOnTheMove, IsSureWhereSeveralKeyframesShowIt) {
  const SeenSurface seen = surface_seen(mapped(box(0), std::nullopt), 0, 0, 1);
  ASSERT_EQ(seen.certainty.size(), seen.points.size());
  MapCloud sure;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    if (seen.certainty[i] == Certainty::sure) sure.push_back(seen.points[i]);
  }
  // The camera turns past the box, whose front most keyframes show.
  EXPECT_GT(sure.size(), seen.points.size() / 3);
  EXPECT_LT(sure.size(), seen.points.size()) << "the edges of the view are in one keyframe alone";
  EXPECT_GT(share_on(box(0), sure), share_on(box(0), seen.points));
}

TEST_F(FurnitureOnTheMove, IsSeenToBeNew) {
  const MapContent content = mapped(std::nullopt, box(0));
  ASSERT_EQ(content.changes.size(), 1);
  const MapChange& change = content.changes.front();
  EXPECT_EQ(change.kind, ChangeKind::appeared);
  EXPECT_TRUE(change.before.empty());
  EXPECT_GT(share_on(box(0), change.after), 0.95);
  EXPECT_GT(share_on(box(0), surface_of(content, change.map)), 0.01) << "the map shows what is";
}

TEST_F(FurnitureOnTheMove, IsSeenToHaveMoved) {
  const MapContent content = mapped(box(-0.5), box(0.5));
  ASSERT_EQ(content.changes.size(), 1);
  const MapChange& change = content.changes.front();
  EXPECT_EQ(change.kind, ChangeKind::moved);
  EXPECT_GT(share_on(box(-0.5), change.before), 0.95);
  EXPECT_GT(share_on(box(0.5), change.after), 0.95);
}

TEST_F(FurnitureOnTheMove, IsNotSeenWhereNothingMoved) {
  EXPECT_TRUE(mapped(box(0), box(0)).changes.empty());
}

}  // namespace
}  // namespace tofmap
