// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/mapping/uncertain_start.hpp>

namespace tofmap {
namespace {

constexpr double step_m = 0.05;

/// Adds frames of a camera that goes to the right, always looking at the front wall, 2 m away. It
/// begins at this distance from the right wall. The left wall is too far away to be seen.
void go_right(RoomMapper& mapper, double to_right_wall_m, int frames) {
  const CameraModel camera = test::small_camera();
  for (int i = 0; i < frames; ++i) {
    const auto cloud = std::make_shared<const SurfaceCloud>(
        test::box_cloud(camera, {-20, -0.8, -2}, {to_right_wall_m, 0.8, 2},
                        test::moved_by({0, 0, 0}, {step_m * i, 0, 0})));
    EXPECT_TRUE(mapper.add_frame({i, i / 15.0, cloud}).tracking.registered()) << i;
  }
}

/// The largest error of a position relative to the last one.
double largest_error_m(const Trajectory& path) {
  double largest_m = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector3d moved =
        path[i].world_from_camera.translation() - path.back().world_from_camera.translation();
    const Eigen::Vector3d true_m(-step_m * static_cast<double>(path.size() - 1 - i), 0, 0);
    largest_m = std::max(largest_m, (moved - true_m).norm());
  }
  return largest_m;
}

TEST(UncertainStart, IsMendedOnceTheMotionIsKnown) {
  // The corner comes into sight after some frames in front of the bare wall, along which the camera
  // could have moved at any speed.
  RoomMapper mapper(test::small_camera(), {}, {}, {}, {});
  go_right(mapper, 1.6, 25);
  EXPECT_GT(largest_error_m(trajectory_of(mapper.content(), 0)), 0.2);
  const double uncertain_m = least_certain(certainties_of(mapper.content(), 0)).error.position_m;
  mapper.finish();
  const MapContent& content = mapper.content();
  EXPECT_LT(largest_error_m(trajectory_of(content, 0)), 0.03);
  EXPECT_TRUE(content.keyframes[0].world_from_camera.isApprox(Pose::Identity()));
  // The surface has moved with the keyframes, and the path is certain now.
  double right_m = 0;
  for (const auto& point : surface_of(content, 0).points)
    right_m = std::max<double>(right_m, point.x);
  EXPECT_NEAR(right_m, 1.6, 0.05);
  EXPECT_LT(least_certain(certainties_of(content, 0)).error.position_m, 0.7 * uncertain_m);
}

TEST(UncertainStart, IsLeftAsItIsIfNothingIsCertainAfterIt) {
  RoomMapper mapper(test::small_camera(), {}, {}, {}, {});
  go_right(mapper, 20, 20);
  MapContent content = mapper.content();
  EXPECT_TRUE(mend_uncertain_start(content, 0, {}, {}, {}).empty());
}

TEST(UncertainStart, IsLeftAsItIsInSightOfACorner) {
  RoomMapper mapper(test::small_camera(), {}, {}, {}, {});
  go_right(mapper, 1.2, 10);
  MapContent content = mapper.content();
  EXPECT_TRUE(mend_uncertain_start(content, 0, {}, {}, {}).empty());
}

}  // namespace
}  // namespace tofmap
