// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tofmap/simulation/door.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

Door sample_door() {
  Door door;
  door.hinge_m = {1, 2, 0.1};
  door.open_rad = 1.4;
  door.swings_s = {2, 6};
  return door;
}

TEST(Door, OpensAtTheFirstSwingAndShutsAtTheSecond) {
  const Door door = sample_door();
  EXPECT_EQ(door.angle_at(-1), 0);
  EXPECT_EQ(door.angle_at(2), 0);
  EXPECT_DOUBLE_EQ(door.angle_at(2 + Door::swing_s / 2), 0.7);
  EXPECT_DOUBLE_EQ(door.angle_at(2 + Door::swing_s), 1.4);
  EXPECT_DOUBLE_EQ(door.angle_at(6), 1.4);
  EXPECT_DOUBLE_EQ(door.angle_at(6 + Door::swing_s / 2), 0.7);
  EXPECT_DOUBLE_EQ(door.angle_at(100), 0);
}

TEST(Door, ThatIsOpenAtFirstShutsFirst) {
  Door door = sample_door();
  door.is_open_at_first = true;
  EXPECT_DOUBLE_EQ(door.angle_at(0), 1.4);
  EXPECT_DOUBLE_EQ(door.angle_at(5), 0);
  EXPECT_DOUBLE_EQ(door.angle_at(9), 1.4);
}

TEST(Door, SwingsNoFasterThanAHandMovesIt) {
  const Door door = sample_door();
  constexpr double step_s = 0.01;
  double fastest = 0;
  for (double time_s = 0; time_s < 9; time_s += step_s) {
    const double moved_rad = std::abs(door.angle_at(time_s + step_s) - door.angle_at(time_s));
    fastest = std::max(fastest, moved_rad / step_s);
  }
  // The smooth step is fastest in its middle, at 1.5 times its mean speed.
  EXPECT_NEAR(fastest, 1.5 * 1.4 / Door::swing_s, 0.01);
}

TEST(Door, LeafTurnsAboutItsHinge) {
  for (const double side : {1.0, -1.0}) {
    Door door = sample_door();
    door.side = side;
    door.open_rad = std::numbers::pi / 2;
    TriangleMesh shut;
    TriangleMesh open;
    add_leaf(shut, door, 0);
    add_leaf(open, door, 5);
    constexpr double half_m = 0.1;  // the thickness of the leaf with its handles
    const Eigen::AlignedBox3d shut_box = bounds(shut);
    EXPECT_NEAR(shut_box.max().x(), door.hinge_m.x() + Door::width_m, 1e-6);
    EXPECT_LT(shut_box.sizes().y(), 2 * half_m);
    const Eigen::AlignedBox3d open_box = bounds(open);
    EXPECT_LT(open_box.sizes().x(), 2 * half_m);
    const double edge_m = door.hinge_m.y() + side * Door::width_m;
    EXPECT_NEAR(side > 0 ? open_box.max().y() : open_box.min().y(), edge_m, 1e-6);
    EXPECT_GT(open_box.min().z(), 0.1);
  }
}

TEST(Door, FrameLeavesRoomForTheLeaf) {
  const Door door = sample_door();
  TriangleMesh frame;
  TriangleMesh leaf;
  add_frame(frame, door);
  add_leaf(leaf, door, 0);
  const Eigen::AlignedBox3d inner = bounds(leaf);
  for (const Eigen::Vector3f& vertex : frame.vertices) {
    const bool is_beside = vertex.x() < inner.min().x() - 0.02 ||
                           vertex.x() > inner.max().x() + 0.02 || vertex.z() > inner.max().z();
    EXPECT_TRUE(is_beside) << vertex.transpose();
  }
  // From the floor to the wall, which is behind the leaf.
  EXPECT_NEAR(bounds(frame).min().z(), door.hinge_m.z(), 1e-6);
  EXPECT_NEAR(bounds(frame).min().y(), door.hinge_m.y() - Door::off_wall_m, 1e-6);
}

}  // namespace
}  // namespace tofmap
