// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/pose_circle.hpp"

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/map_join.hpp>

namespace tofmap {
namespace {

using test::along_x;
using test::loop;
using test::moved_by;

/// Ten keyframes of map 0 and ten of map 1, both along x, half a metre apart. Map 1 lies elsewhere
/// in the world of map 0.
class TwoMaps : public testing::Test {
 protected:
  TwoMaps() {
    for (int id = 0; id < 20; ++id) {
      keyframes_.push_back({.id = id,
                            .world_from_camera = along_x(0.5 * (id % 10)),
                            .path_m = 0.5 * id,
                            .map = id / 10});
    }
  }

  /// The place of keyframe `to` of map 1 is recognised by `from` of map 0, `ahead_m` too far.
  void recognise(int from, int to, double ahead_m = 0) {
    const Pose truth = first_from_second_ * pose(to);
    recognitions_.push_back(loop(from, to, pose(from).inverse() * truth * along_x(ahead_m), 0.005));
  }

  const Pose& pose(int id) const {
    return keyframes_[static_cast<std::size_t>(id)].world_from_camera;
  }

  std::optional<MapJoin> join() const { return find_join(recognitions_, 1, keyframes_, {}); }

  const Pose first_from_second_ = moved_by({0.1, 0, 1}, {1, 2, 3});
  std::vector<Keyframe> keyframes_;
  std::vector<PoseEdge> recognitions_;
};

TEST_F(TwoMaps, AreJoinedWhenThreeKeyframesAgree) {
  recognise(2, 12);
  recognise(2, 13);
  EXPECT_FALSE(join());
  recognise(4, 15);
  const auto found = join();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->into, 0);
  EXPECT_EQ(found->map, 1);
  EXPECT_EQ(found->edges.size(), 3U);
  EXPECT_TRUE(found->into_from_map.isApprox(first_from_second_, 1e-9));
}

TEST_F(TwoMaps, AreJoinedWhereMostRecognitionsAreNear) {
  recognise(1, 11, -0.1);
  recognise(2, 12, 0.01);
  recognise(3, 13);
  recognise(4, 14, -0.01);
  recognise(5, 15, 0.1);
  const auto found = join();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->edges.size(), 5U);
  EXPECT_TRUE(found->into_from_map.isApprox(first_from_second_, 1e-9));
}

TEST_F(TwoMaps, AreNotJoinedByOneKeyframeAlone) {
  for (int from = 2; from < 6; ++from) recognise(from, 12);
  EXPECT_FALSE(join());
}

TEST_F(TwoMaps, AreNotJoinedWhileOthersDisagree) {
  for (int i = 0; i < 3; ++i) recognise(i, 10 + i);
  for (int i = 3; i < 6; ++i) recognise(i, 10 + i, 2);
  EXPECT_FALSE(join()) << "two places look alike";
  recognise(6, 16);
  EXPECT_TRUE(join()) << "most know";
}

TEST_F(TwoMaps, AreNotJoinedByWhatOtherMapsRecognise) {
  for (int i = 0; i < 3; ++i) recognise(i, 10 + i);
  EXPECT_FALSE(find_join(recognitions_, 0, keyframes_, {}));
}

}  // namespace
}  // namespace tofmap
