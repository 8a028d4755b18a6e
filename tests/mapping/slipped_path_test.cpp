// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/scenery.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

constexpr int last_before_jump = 30;
constexpr double frame_rate_hz = 15;

/// Frames of a path through the room and back to where it began. On the way there the camera jumps,
/// as if frames were lost of which the timestamps tell nothing.
std::vector<int> path_with_a_jump(int first_after_jump) {
  constexpr int farthest = 99;
  std::vector<int> path;
  for (int frame = 0; frame <= last_before_jump; ++frame) path.push_back(frame);
  for (int frame = first_after_jump; frame <= farthest; ++frame) path.push_back(frame);
  for (int frame = farthest; frame >= 0; --frame) path.push_back(frame);
  return path;
}

/// By how much each registered frame is off; `truth` has the poses of all frames.
std::vector<double> errors_m(const RoomMapper& mapper, const std::vector<Pose>& truth) {
  std::vector<double> errors;
  for (const StampedPose& pose : trajectory_of(mapper.content(), 0)) {
    const auto i = static_cast<std::size_t>(std::lround(pose.timestamp_s * frame_rate_hz));
    const Eigen::Vector3d found_m = truth[0] * pose.world_from_camera.translation();
    errors.push_back((found_m - truth[i].translation()).norm());
  }
  return errors;
}

/// The first frame after a jump, and by how much the path slips at least.
struct Jump {
  int first_after;
  double least_slip_m;
};

class SlippedPath : public testing::TestWithParam<Jump> {};

TEST_P(SlippedPath, IsMendedByOneLoop) {
  const test::Scenery room{"room"};
  const std::vector<int> path = path_with_a_jump(GetParam().first_after);
  // Of a frame that is far from where it was expected, other poses would be tried.
  const OdometryOptions unchecked{.check_poses = false};
  RoomMapper mapper(room.camera(), unchecked, {}, {.min_keyframes = 15}, {});
  std::vector<Pose> truth;
  for (const int frame : path) truth.push_back(room.pose(frame));
  std::vector<double> at_first_m;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const int place = static_cast<int>(i);
    const auto added = mapper.add_frame({place, place / frame_rate_hz, room.view(path[i])});
    ASSERT_TRUE(added.tracking.registered()) << i;
    if (mapper.content().loops.empty()) at_first_m = errors_m(mapper, truth);
  }
  mapper.finish();

  EXPECT_LT(at_first_m[last_before_jump], 0.01);
  EXPECT_GT(*std::ranges::min_element(at_first_m.begin() + last_before_jump + 1, at_first_m.end()),
            GetParam().least_slip_m);
  ASSERT_EQ(mapper.content().loops.size(), 1U);
  EXPECT_TRUE(mapper.content().loops.front().is_used);
  const std::vector<double> mended_m = errors_m(mapper, truth);
  ASSERT_EQ(mended_m.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    // The first frame after the jump stays where it was registered, with the keyframe before.
    if (i == last_before_jump + 1) continue;
    EXPECT_LT(mended_m[i], 0.01) << i;
  }
}

// Registration of the keyframe reaches the first slip, but not the second.
INSTANTIATE_TEST_SUITE_P(Jumps, SlippedPath, testing::Values(Jump{37, 0.3}, Jump{40, 0.5}));

}  // namespace
}  // namespace tofmap
