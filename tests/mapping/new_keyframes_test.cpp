// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

/// Whether the second of two frames becomes a keyframe. The camera stands still; the first frame
/// may see a box, 0.5 m ahead, that is gone in the second one.
bool second_is_keyframe(double box_width_m) {
  const test::Scenery room{"room"};
  const Pose pose = room.pose(0);
  const Eigen::Vector3d half(box_width_m / 2, box_width_m / 2, box_width_m / 2);
  const Eigen::Vector3d centre = pose * Eigen::Vector3d(0, 0, 0.5 + box_width_m / 2);
  RoomMapper mapper(room.camera(), {}, {}, {}, {});
  mapper.add_frame({0, 0, room.view(0, Eigen::AlignedBox3d(centre - half, centre + half))});
  const TrackingResult second = mapper.add_frame({1, 1 / 15.0, room.view(0)}).tracking;
  EXPECT_TRUE(second.registered());
  return second.is_keyframe;
}

TEST(NewKeyframes, AreTakenWhereMuchComesIntoView) {
  EXPECT_TRUE(second_is_keyframe(0.45));
  EXPECT_FALSE(second_is_keyframe(0.1));
}

}  // namespace
}  // namespace tofmap
