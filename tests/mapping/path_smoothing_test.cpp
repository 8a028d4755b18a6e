// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/path_smoothing.hpp"

#include "support/box_room.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6>;

const MotionUncertainty motion(0.03, 0.03);
constexpr int keyframe_step = 20;

Pose true_pose(int frame) {
  return test::moved_by({0, 0.002 * frame, 0}, {0.03 * frame, 0, 0.01 * frame});
}

/// What surfaces tell that leave the x-axis open.
Covariance sideways_open() {
  Covariance covariance = 1e-6 * Covariance::Identity();
  covariance(3, 3) = 1;
  return covariance;
}

/// A path with a keyframe every 20 frames. Frames are where they should be, and known to 1 mm.
MapContent path(int frames) {
  MapContent content(test::small_camera(), {});
  content.recordings.emplace_back();
  const auto cloud = std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), {-1, -1, -1}, {1, 1, 2}, Pose::Identity()));
  for (int i = 0; i < frames; ++i) {
    if (i % keyframe_step == 0) {
      content.keyframes.add({.id = content.keyframes.size(),
                             .frame_index = i,
                             .timestamp_s = i / 15.0,
                             .world_from_camera = true_pose(i),
                             .cloud = cloud});
    }
    const Keyframe& keyframe = content.keyframes[i / keyframe_step];
    content.frames.push_back(
        {.timestamp_s = i / 15.0,
         .keyframe = keyframe.id,
         .keyframe_from_camera = keyframe.world_from_camera.inverse() * true_pose(i),
         .index = i});
    if (i % keyframe_step != 0) content.frames.back().covariance = 1e-6 * Covariance::Identity();
  }
  return content;
}

/// Moves a frame along the x-axis of the world, and leaves its surfaces open in this direction.
void slide(MapContent& content, int frame, double distance_m) {
  RegisteredFrame& moved = content.frames[static_cast<std::size_t>(frame)];
  const Pose& keyframe = content.keyframes[moved.keyframe].world_from_camera;
  moved.keyframe_from_camera = keyframe.inverse() * (Eigen::Translation3d(distance_m, 0, 0) *
                                                     (keyframe * moved.keyframe_from_camera));
  moved.covariance = rotated(sideways_open(), keyframe.linear().transpose());
}

double error_m(const MapContent& content, int frame) {
  return (pose_of(content.frames[static_cast<std::size_t>(frame)], content.keyframes)
              .translation() -
          true_pose(frame).translation())
      .norm();
}

double sigma_m(const MapContent& content, int frame) {
  return spread_of(content.frames[static_cast<std::size_t>(frame)].covariance)
      .translation_sigma_m();
}

void smooth(MapContent& content) { smooth_path(content, 0, motion); }

TEST(PathSmoothing, TakesBackWhatFramesHaveSlidBetweenKeyframes) {
  // Frames slide ever farther until a keyframe knows better.
  MapContent content = path(60);
  for (int i = 31; i < 40; ++i) slide(content, i, 0.005 * (i - 30));
  smooth(content);
  for (int i = 0; i < 60; ++i) EXPECT_LT(error_m(content, i), 0.005) << i;
  // The motion holds frames less well than surfaces, but better than nothing.
  EXPECT_GT(sigma_m(content, 35), 2 * sigma_m(content, 25));
  EXPECT_LT(sigma_m(content, 35), 0.1);
}

TEST(PathSmoothing, LeavesFramesWhereTheirSurfacesHoldThem) {
  MapContent content = path(60);
  slide(content, 35, 0.01);
  content.frames[35].covariance = 1e-6 * Covariance::Identity();
  smooth(content);
  EXPECT_NEAR(error_m(content, 35), 0.01, 0.001);
}

TEST(PathSmoothing, DoesNotBelieveOneFrameThatIsCertainWhereThoseBesideItAreNot) {
  MapContent content = path(60);
  for (int i = 31; i < 40; ++i) slide(content, i, -0.08);
  for (const int i : {33, 37}) {
    content.frames[static_cast<std::size_t>(i)].covariance = 1e-6 * Covariance::Identity();
  }
  smooth(content);
  // They still count a little, and the motion holds frames less well than surfaces.
  for (int i = 31; i < 40; ++i) EXPECT_LT(error_m(content, i), 0.02) << i;
}

TEST(PathSmoothing, KnowsThatTheMotionMayChangeInAGap) {
  // After two seconds without frames, the camera may be anywhere.
  MapContent content = path(60);
  for (int i = 35; i < 60; ++i) content.frames[static_cast<std::size_t>(i)].timestamp_s += 2;
  slide(content, 35, 0.1);
  slide(content, 34, 0);
  smooth(content);
  EXPECT_LT(error_m(content, 34), 0.001);
}

TEST(PathSmoothing, IsTheSameForALongPath) {
  // Long paths are smoothed piece by piece, with a border at frame 1000.
  constexpr int begin = 700;
  MapContent content = path(1500);
  for (int i = 995; i < 1012; ++i) {
    if (i % keyframe_step != 0) slide(content, i, 0.02);
  }
  MapContent without_begin = content;
  std::erase_if(without_begin.frames,
                [](const RegisteredFrame& frame) { return frame.index < begin; });
  smooth(content);
  smooth(without_begin);
  for (std::size_t i = 0; i < without_begin.frames.size(); ++i) {
    // How steady the motion is was learned from fewer frames.
    const Eigen::Vector3d apart_m = without_begin.frames[i].keyframe_from_camera.translation() -
                                    content.frames[begin + i].keyframe_from_camera.translation();
    EXPECT_LT(apart_m.norm(), 1e-3) << begin + i;
  }
}

TEST(PathSmoothing, LeavesOtherRecordings) {
  MapContent content = path(30);
  slide(content, 10, 0.1);
  smooth_path(content, 1, motion);
  EXPECT_NEAR(error_m(content, 10), 0.1, 1e-9);
}

}  // namespace
}  // namespace tofmap
