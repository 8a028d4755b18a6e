// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "levelled_cloud.hpp"

#include <gtest/gtest.h>
#include <support/scans.hpp>

#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

/// What a camera sees of a room that turns on the spot, in the frame of its first pose.
PointSet scan_all_round() {
  const Scene scene = make_scene("room");
  const RayScene rays(scene.surface);
  PointSet all;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Pose turn = test::moved_by({0, quarter * std::numbers::pi / 2, 0}, {0, 0, 0});
    const PointSet seen = test::scan(rays, scene.path.pose_at(0) * turn);
    const PointSet turned = test::moved(seen, turn);
    all.points.insert(all.points.end(), turned.points.begin(), turned.points.end());
  }
  return all;
}

/// The possible views of a cloud whose sensor is unknown, and the origin in the frame of the views.
struct Views {
  std::vector<SphericalView> views;
  Eigen::Vector3d origin_m;
};

Views views_of(const PointSet& cloud) {
  const auto levels = make_levels(cloud, {}, 1, 0.1);
  return {levels->views, -levels->centre_m};
}

TEST(PossibleViews, IncludeOneFromNearTheSensor) {
  const auto [views, sensor_m] = views_of(scan_all_round());
  ASSERT_FALSE(views.empty());
  double nearest_m = 100;
  for (const SphericalView& view : views) {
    nearest_m = std::min(nearest_m, (view.from_m() - sensor_m).norm());
  }
  EXPECT_LT(nearest_m, 0.5);
}

TEST(PossibleViews, AreTheOneOfTheSensorIfThatIsKnown) {
  const auto levels =
      make_levels(scan_all_round(), {SensorSource::given, Eigen::Vector3d(1, 0, 0)}, 1, 0.1);
  ASSERT_EQ(levels->views.size(), 1U);
  EXPECT_LT((levels->views.front().from_m() + levels->centre_m - Eigen::Vector3d(1, 0, 0)).norm(),
            1e-9);
}

TEST(PossibleViews, AreNoneOfWallsThatNoPlaceSeesTogether) {
  // Shelves: five walls, one behind the other, that are wider than they are apart.
  PointSet shelves;
  for (int wall = 0; wall < 5; ++wall) {
    for (int i = -50; i <= 50; ++i) {
      for (int k = -30; k <= 30; ++k) shelves.points.emplace_back(0.1 * i, 0.1 * k, 0.8 * wall);
    }
  }
  EXPECT_TRUE(views_of(shelves).views.empty());
}

}  // namespace
}  // namespace tofmap
