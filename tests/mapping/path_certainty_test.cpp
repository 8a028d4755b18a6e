// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <memory>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

/// A camera that goes sideways, 5 cm a frame, in a room of this width. It begins 1 m from the left
/// wall and always looks at the front wall, 2 m away.
RoomMapper mapped_sideways(double width_m, int frames) {
  const CameraModel camera = test::small_camera();
  RoomMapper mapper(camera, {}, {}, {}, {});
  for (int i = 0; i < frames; ++i) {
    const auto cloud = std::make_shared<const SurfaceCloud>(
        test::box_cloud(camera, {-1, -0.8, -2}, {width_m - 1, 0.8, 2},
                        test::moved_by({0, 0, 0}, {0.05 * i, 0, 0})));
    EXPECT_TRUE(mapper.add_frame({i, i / 15.0, cloud}).tracking.registered()) << i;
  }
  mapper.finish();
  return mapper;
}

TEST(PathCertainty, IsLostAlongABareWall) {
  // From frame 10 on, the camera has left the corner behind.
  const PoseCertainty least = least_certain(certainties_of(mapped_sideways(20, 60).content(), 0));
  EXPECT_GT(least.error.position_m, 0.05);
  EXPECT_GT(least.frame, 30);
}

TEST(PathCertainty, IsKeptInSightOfACorner) {
  EXPECT_LT(least_certain(certainties_of(mapped_sideways(20, 6).content(), 0)).error.position_m,
            0.02);
}

}  // namespace
}  // namespace tofmap
