// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "target_choice.hpp"

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using test::moved_by;
using test::small_camera;

using Selection = std::function<bool(const SurfacePoint&)>;

/// A view into a box, whose far wall is z = 3.5, with the surfaces of some points alone.
std::shared_ptr<const SurfaceCloud> view(const Selection& is_kept) {
  SurfaceCloud cloud =
      test::box_cloud(small_camera(), {-1.5, -1, -2.5}, {2, 1.2, 3.5}, Pose::Identity());
  for (SurfacePoint& point : cloud.points) {
    if (!is_kept(point)) point.normal_z = NAN;
  }
  return std::make_shared<const SurfaceCloud>(cloud);
}

bool is_wall(const SurfacePoint& point) { return std::abs(point.normal_z) > 0.9; }
bool is_at_left(const SurfacePoint& point) { return point.x < -0.8; }
bool is_anything(const SurfacePoint&) { return true; }

/// Three keyframes that see the far wall alone, and before them one that overlaps less.
class TargetChoice : public testing::Test {
 protected:
  TargetChoice() {
    add(is_at_left);
    for (int i = 0; i < 3; ++i) add(is_wall);
    options_.targets = 3;
  }

  void add(const Selection& is_kept) {
    const int id = static_cast<int>(keyframes_.size());
    keyframes_.push_back({.id = id, .cloud = view(is_kept)});
  }

  /// Ids of the keyframes that a frame from the same place is registered with.
  std::vector<int> chosen(const Selection& is_seen) const {
    std::vector<const Keyframe*> around;
    for (const Keyframe& keyframe : keyframes_) around.push_back(&keyframe);
    const MotionPrior prior{Pose::Identity(), 0.02, 0.03};
    std::vector<int> ids;
    for (const Keyframe* keyframe :
         choose_targets(*view(is_seen), prior, around, small_camera(), options_, {})) {
      ids.push_back(keyframe->id);
    }
    return ids;
  }

  std::vector<Keyframe> keyframes_;
  OdometryOptions options_;
};

TEST_F(TargetChoice, TakesThoseThatOverlapMostAndTheNewestOfEqualOnes) {
  add(is_wall);
  EXPECT_EQ(chosen(is_wall), (std::vector{4, 3, 2}));
}

TEST_F(TargetChoice, GivesTheLastPlaceToOneThatAloneConstrainsADirection) {
  EXPECT_EQ(chosen(is_anything), (std::vector{3, 2, 0}));
}

TEST_F(TargetChoice, KeepsTheLargerOverlapWhereAllConstrainTheSame) {
  for (Keyframe& keyframe : keyframes_) {
    if (keyframe.id > 0) keyframe.cloud = view(is_anything);
  }
  EXPECT_EQ(chosen(is_anything), (std::vector{3, 2, 1}));
}

TEST_F(TargetChoice, TakesTheLargestOverlapForASingleTarget) {
  options_.targets = 1;
  EXPECT_EQ(chosen(is_anything), (std::vector{3}));
}

TEST_F(TargetChoice, GivesNoPlaceToOneThatOverlapsTooLittle) {
  options_.min_target_overlap = 0.4;
  std::rotate(keyframes_.begin(), keyframes_.begin() + 1,
              keyframes_.end());  // the newest needs no overlap
  EXPECT_EQ(chosen(is_anything), (std::vector{3, 2, 1}));
}

TEST_F(TargetChoice, LeavesOutWhatOverlapsTooLittleButForTheNewest) {
  options_.targets = 4;
  options_.min_target_overlap = 0.1;
  EXPECT_EQ(chosen(is_wall), (std::vector{3, 2, 1, 0}));
  options_.min_target_overlap = 0.7;
  EXPECT_EQ(chosen(is_wall), (std::vector{3, 2, 1}));
  add([](const SurfacePoint&) { return false; });
  EXPECT_EQ(chosen(is_wall), (std::vector{3, 2, 1, 4}));
  keyframes_.erase(keyframes_.begin(), keyframes_.end() - 1);
  EXPECT_EQ(chosen(is_wall), (std::vector{4}));
}

}  // namespace
}  // namespace tofmap
