// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"
#include "support/scenery.hpp"

#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/loop_closure.hpp>
#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;
using test::moved_by;
using test::small_camera;

// Not a cube: each wall is at another distance.
const Vector3d loop_room_min(-1.5, -1.0, -2.5);
const Vector3d loop_room_max(2.0, 1.2, 3.5);

Keyframe keyframe(int id, const Pose& truth, const Pose& believed) {
  return {.id = id,
          .frame_index = 10 * id,
          .timestamp_s = 1.0 * id,
          .world_from_camera = believed,
          .cloud = std::make_shared<const SurfaceCloud>(
              test::box_cloud(small_camera(), loop_room_min, loop_room_max, truth))};
}

/// One keyframe long ago, and one that sees the same corner from near by, whose pose has drifted.
class FindLoop : public testing::Test {
 protected:
  FindLoop() {
    options_.min_keyframes = 1;
    keyframes_.push_back(keyframe(0, old_truth_, old_truth_));
    keyframes_.push_back(keyframe(1, new_truth_, drift_ * new_truth_));
  }

  LoopCandidate find() const {
    return find_loop(keyframes_[1], keyframes_, spreads_, small_camera(), options_, {});
  }

  Pose old_truth_ = moved_by({0.1, 0.5, 0}, {0, 0, 0});
  Pose new_truth_ = moved_by({0.05, 0.6, 0}, {0.2, 0.1, 0.1});
  Pose drift_ = moved_by({0, 0.01, 0.01}, {0.04, -0.02, 0.03});
  std::vector<Keyframe> keyframes_;
  std::vector<std::optional<PoseSpread>> spreads_{PoseSpread{}, PoseSpread{}};
  LoopOptions options_;
};

TEST_F(FindLoop, MeasuresTheMotionSinceAPlaceSeenBefore) {
  keyframes_[1].path_m = 20;
  const LoopCandidate candidate = find();
  ASSERT_TRUE(candidate.edge);
  EXPECT_EQ(candidate.edge->from, 0);
  EXPECT_EQ(candidate.edge->to, 1);
  EXPECT_TRUE(candidate.edge->may_be_wrong);
  const Pose truth = old_truth_.inverse() * new_truth_;
  const Pose error = truth.inverse() * candidate.edge->from_from_to;
  EXPECT_LT(error.translation().norm(), 2e-3);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 1e-3);
  // The covariance tells of such an error.
  EXPECT_LT(candidate.edge->covariance.diagonal().tail<3>().maxCoeff(), 0.01 * 0.01);
}

TEST_F(FindLoop, PassesOverKeyframesThatWereJustThere) {
  options_.min_keyframes = 2;
  EXPECT_EQ(find().from, -1);
}

TEST_F(FindLoop, DoesNotPassOverKeyframesJustNowIfThePathSinceIsUncertain) {
  options_.min_keyframes = 2;
  spreads_[0] = PoseSpread{0.001, 0.01};
  EXPECT_TRUE(find().edge);
}

TEST_F(FindLoop, LooksAsFarAsThePathIsUncertain) {
  options_.radius_m = 0.1;
  spreads_[0] = PoseSpread{0.001, 0.01};
  EXPECT_TRUE(find().edge);
}

TEST_F(FindLoop, PassesOverKeyframesThatLookElsewhere) {
  keyframes_[0] = keyframe(0, moved_by({0, 2.5, 0}, {0, 0, 0}), moved_by({0, 2.5, 0}, {0, 0, 0}));
  EXPECT_EQ(find().from, -1);
}

TEST_F(FindLoop, PassesOverKeyframesFarAway) {
  options_.radius_m = 0.1;
  EXPECT_EQ(find().from, -1);
}

TEST_F(FindLoop, DoesNotVerifyABareWall) {
  // All that is seen is one wall: nothing tells of motion along it.
  keyframes_[0].cloud = std::make_shared<const SurfaceCloud>(
      test::box_cloud(small_camera(), {-50, -50, -50}, {50, 50, 2}, Pose::Identity()));
  keyframes_[0].world_from_camera = Pose::Identity();
  keyframes_[1].cloud = keyframes_[0].cloud;
  keyframes_[1].world_from_camera = moved_by({0, 0, 0}, {0.03, 0, 0.02});
  const LoopCandidate candidate = find();
  EXPECT_EQ(candidate.from, 0);
  EXPECT_GT(candidate.registration.degenerate_directions, 0);
  EXPECT_FALSE(candidate.edge);
}

TEST_F(FindLoop, DoesNotVerifyAnotherPlaceThatStandsWhereItIsBelievedToBe) {
  keyframes_[0].cloud = std::make_shared<const SurfaceCloud>(
      test::box_cloud(small_camera(), {-0.8, -0.5, -1}, {0.9, 0.7, 1.4}, old_truth_));
  EXPECT_FALSE(find().edge);
}

/// A furnished room seen again after a long path, far from where it is believed to be.
class FindLoopFarOff : public testing::Test {
 protected:
  FindLoopFarOff() {
    for (int id = 0; id < 4; ++id) add(100 + 2 * id, 0, Pose::Identity());
    add(103, path_m_, moved_by({0, 0.1, 0.02}, {0.7, 0.4, -0.3}));
    options_.min_keyframes = 1;
  }

  void add(int frame, double path_m, const Pose& drift) {
    const auto cloud = room_.view(frame);
    keyframes_.push_back({.id = static_cast<int>(keyframes_.size()),
                          .frame_index = frame,
                          .world_from_camera = drift * room_.pose(frame),
                          .cloud = cloud,
                          .path_m = path_m,
                          .place = PlaceDescriptor(*cloud)});
  }

  LoopCandidate find() const {
    const std::vector<std::optional<PoseSpread>> spreads(keyframes_.size(), PoseSpread{});
    return find_loop(keyframes_.back(), keyframes_, spreads, room_.camera(), options_, {});
  }

  double path_m_ = 80;
  test::Scenery room_{"room"};
  std::vector<Keyframe> keyframes_;
  LoopOptions options_;
};

TEST_F(FindLoopFarOff, RecognisesThePlace) {
  const LoopCandidate candidate = find();
  ASSERT_TRUE(candidate.edge);
  const Pose truth =
      room_.pose(keyframes_[static_cast<std::size_t>(candidate.from)].frame_index).inverse() *
      room_.pose(103);
  EXPECT_LT((truth.inverse() * candidate.edge->from_from_to).translation().norm(), 0.01);
}

TEST_F(FindLoopFarOff, DoesNotBelieveInMoreDriftThanThePathAllows) {
  keyframes_.back().path_m = 2;
  EXPECT_FALSE(find().edge);
}

TEST_F(FindLoopFarOff, NeedsASlipToExplainWhatDriftDoesNot) {
  EXPECT_FALSE(find().needs_slip);
  keyframes_.pop_back();
  add(103, 2, moved_by({0, 0.02, 0}, {0.4, 0.3, -0.2}));
  const LoopCandidate candidate = find();
  EXPECT_TRUE(candidate.edge);
  EXPECT_TRUE(candidate.needs_slip);
}

/// A camera that turns round once in a box, and a little more. It always sees a corner: before a
/// bare wall nothing would tell of motion along it.
class Turning : public testing::Test {
 protected:
  static constexpr int frames = 80;

  static CameraModel wide_camera() {
    CameraModel camera = small_camera();
    camera.fx_px = camera.fy_px = 26;  // 102 degrees wide
    return camera;
  }

  static Pose camera_at(int frame) {
    const double angle = 2 * std::numbers::pi * frame / 72;
    return moved_by({0, angle, 0}, {0.1 * std::sin(angle), 0, 0.1 * std::cos(angle)});
  }

  void run(RoomMapper& mapper, int end = frames) {
    for (int i = 0; i < end; ++i) {
      const auto cloud = std::make_shared<const SurfaceCloud>(
          test::box_cloud(wide_camera(), box_min_, box_max_, camera_at(i)));
      ASSERT_TRUE(mapper.add_frame({i, i / 15.0, cloud}).tracking.registered()) << i;
    }
    mapper.finish();
  }

  Vector3d box_min_{-1.0, -0.8, -1.1};
  Vector3d box_max_{1.1, 0.9, 1.2};
  LoopOptions loops_{.min_keyframes = 15};
};

/// How far the frame is off at the end, from where the path began.
double last_error_m(const RoomMapper& mapper, const Pose& truth) {
  return (truth.inverse() * trajectory_of(mapper.content(), 0).back().world_from_camera)
      .translation()
      .norm();
}

double last_rotation_error_rad(const RoomMapper& mapper, const Pose& truth) {
  return rotation_angle_rad(trajectory_of(mapper.content(), 0).back().world_from_camera, truth);
}

TEST_F(Turning, ClosesTheLoop) {
  RoomMapper mapper(wide_camera(), {}, {}, loops_, {});
  run(mapper);
  ASSERT_FALSE(mapper.content().loops.empty());
  for (const Loop& loop : mapper.content().loops) {
    EXPECT_GE(loop.to_frame, 60);
    EXPECT_LT(loop.from_frame, 20);
    EXPECT_TRUE(loop.is_used);
  }
  ASSERT_EQ(trajectory_of(mapper.content(), 0).size(), static_cast<std::size_t>(frames));
  loops_.close = false;
  RoomMapper open(wide_camera(), {}, {}, loops_, {});
  run(open);
  EXPECT_TRUE(open.content().loops.empty());
  const Pose truth = camera_at(0).inverse() * camera_at(frames - 1);
  EXPECT_LT(last_error_m(mapper, truth), 0.5 * last_error_m(open, truth));
}

TEST_F(Turning, NeedsNoNewKeyframesWhereAPlaceIsSeenAgain) {
  RoomMapper once(wide_camera(), {}, {}, loops_, {});
  run(once, 100);
  RoomMapper thrice(wide_camera(), {}, {}, loops_, {});
  run(thrice, 216);
  const std::size_t keyframes = keyframe_trajectory_of(once.content(), 0).size();
  EXPECT_LT(keyframes, 50U);
  EXPECT_EQ(keyframe_trajectory_of(thrice.content(), 0).size(), keyframes);
  EXPECT_EQ(trajectory_of(thrice.content(), 0).size(), 216U);
  // One standard deviation of the loop that connects the last keyframe with the first one.
  EXPECT_LT(last_error_m(thrice, camera_at(0).inverse() * camera_at(215)), 2.8e-3);
}

TEST_F(Turning, IsMendedByThreeLoopsIfTheFocalLengthIsWrong) {
  CameraModel wrong = wide_camera();
  wrong.fx_px *= 1.02;
  RoomMapper mapper(wrong, {}, {}, loops_, {});
  double before_rad = 0;
  std::vector<int> keyframes;
  for (int i = 0; i < frames; ++i) {
    const RangeImage image = test::box_ranges(wide_camera(), box_min_, box_max_, camera_at(i));
    const auto cloud =
        std::make_shared<const SurfaceCloud>(surface_cloud(image, pixel_rays(wrong), {}));
    const TrackingResult result = mapper.add_frame({i, i / 15.0, cloud}).tracking;
    ASSERT_TRUE(result.registered()) << i;
    if (result.is_keyframe) keyframes.push_back(i);
    if (mapper.content().loops.empty()) {
      before_rad = last_rotation_error_rad(mapper, camera_at(0).inverse() * camera_at(i));
    }
  }
  mapper.finish();
  const double after_rad =
      last_rotation_error_rad(mapper, camera_at(0).inverse() * camera_at(frames - 1));
  EXPECT_GT(before_rad, 0.05);
  EXPECT_LT(after_rad, 0.2 * before_rad);
  ASSERT_EQ(mapper.content().loops.size(), 3U);
  for (const Loop& loop : mapper.content().loops) EXPECT_TRUE(loop.is_used);
  // The first loop waits for others, and keyframes are taken closer together.
  const auto first = std::ranges::find(keyframes, mapper.content().loops[0].to_frame);
  ASSERT_GT(first - keyframes.begin(), 2);
  EXPECT_LT(mapper.content().loops[2].to_frame - *first, *first - *(first - 2));
}

TEST_F(Turning, MovesPathAndMapTogether) {
  const SurfaceMapOptions every_point{.min_observations = 1};
  RoomMapper mapper(wide_camera(), {}, {}, loops_, every_point);
  run(mapper);
  // As if all frames had been integrated where they are believed to be in the end.
  SurfaceMap anew(every_point);
  const Trajectory trajectory = trajectory_of(mapper.content(), 0);
  for (int i = 0; i < frames; ++i) {
    anew.integrate(test::box_cloud(wide_camera(), box_min_, box_max_, camera_at(i)),
                   trajectory[static_cast<std::size_t>(i)].world_from_camera);
  }
  // Shares of the points that lie off the walls of the box, in the frame of the first camera.
  const auto share_off_walls = [&](const MapCloud& map) {
    double off = 0;
    for (const MapPoint& point : map) {
      const Vector3d in_box = camera_at(0) * point.getVector3fMap().cast<double>();
      const double to_wall_m = std::min((in_box - box_min_).cwiseAbs().minCoeff(),
                                        (box_max_ - in_box).cwiseAbs().minCoeff());
      off += to_wall_m > 0.02 ? 1 : 0;
    }
    return off / static_cast<double>(map.size());
  };
  const MapCloud map = surface_of(mapper.content(), 0);
  EXPECT_GT(map.size(), 5000U);
  // Voxels of parts are averages: at the borders between voxels they may fall into others.
  EXPECT_LT(share_off_walls(map), share_off_walls(anew.extract()) + 0.02);
}

}  // namespace
}  // namespace tofmap
