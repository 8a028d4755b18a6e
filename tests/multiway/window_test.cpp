// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "window.hpp"

#include "wall.hpp"

#include <functional>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr double reach_m = 0.4;

/// A wall of 5 m by 4 m. Of what is_pane says, the other cloud shows free space, of the others
/// a surface.
struct Facade {
  OrientedCloud cloud = test::oriented(test::wall(4, 2.5, 2));
  std::vector<int> region;
  std::vector<Sight> sights;

  explicit Facade(const std::function<bool(double y_m, double z_m)>& is_pane) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool is_free = is_pane(cloud.points_m[i].y(), cloud.points_m[i].z());
      if (is_free) region.push_back(static_cast<int>(i));
      sights.push_back(is_free ? Sight::free_space : Sight::surface);
    }
  }

  bool may_be_window() const { return tofmap::may_be_window(cloud, region, sights, reach_m); }
};

bool is_small_pane(double y_m, double z_m) { return std::abs(y_m) < 0.65 && std::abs(z_m) < 0.55; }

TEST(Window, IsAPaneThatAWallSurrounds) { EXPECT_TRUE(Facade(is_small_pane).may_be_window()); }

TEST(Window, IsNoDoor) {
  const Facade door([](double y_m, double z_m) { return std::abs(y_m) < 0.45 && z_m < 0.05; });
  EXPECT_FALSE(door.may_be_window());
}

TEST(Window, IsNotWiderThanThreeMetres) {
  const Facade wide(
      [](double y_m, double z_m) { return std::abs(y_m) < 1.75 && std::abs(z_m) < 0.55; });
  EXPECT_FALSE(wide.may_be_window());
}

TEST(Window, IsFlat) {
  Facade bent(is_small_pane);
  for (const int i : bent.region) {
    Eigen::Vector3f& point_m = bent.cloud.points_m[static_cast<std::size_t>(i)];
    point_m.x() -= 0.5F * std::abs(point_m.y());
  }
  EXPECT_FALSE(bent.may_be_window());
}

TEST(Window, HasAFrameThatBothCloudsShow) {
  Facade alone(is_small_pane);
  for (Sight& sight : alone.sights) {
    if (sight == Sight::surface) sight = Sight::nothing;
  }
  EXPECT_FALSE(alone.may_be_window());
}

TEST(Window, HasAFrameParallelToThePane) {
  Facade corners(is_small_pane);
  for (Eigen::Vector3f& normal : corners.cloud.normals) normal = Eigen::Vector3f::UnitZ();
  EXPECT_FALSE(corners.may_be_window());
}

TEST(Window, IsMoreThanTwoPoints) {
  Facade facade(is_small_pane);
  facade.region.resize(2);
  EXPECT_FALSE(facade.may_be_window());
}

}  // namespace
}  // namespace tofmap
