// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include <tofmap/simulation/person.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

TriangleMesh person_in(const PersonStance& stance, double height_m = 1.75) {
  TriangleMesh mesh;
  add_person(mesh, {.height_m = height_m}, stance);
  return mesh;
}

TEST(Person, TouchesTheFloorInEveryPhaseOfTheStride) {
  for (int i = 0; i < 24; ++i) {
    const PersonStance stance{.foot_m = {1, 2, 0.3},
                              .gait_rad = 2 * std::numbers::pi * i / 24,
                              .swing_rad = max_swing_rad};
    // Vertices are in single precision.
    EXPECT_NEAR(bounds(person_in(stance)).min().z(), 0.3, 1e-6) << i;
  }
}

TEST(Person, IsAsTallAsItsLook) {
  for (const double height_m : {1.6, 1.9}) {
    const Eigen::AlignedBox3d box = bounds(person_in({}, height_m));
    // The knees are bent a little, and the crown is rounded.
    EXPECT_NEAR(box.sizes().z() / height_m, 1, 0.015);
    EXPECT_GT(box.sizes().y(), 0.26 * height_m);  // across the shoulders
    EXPECT_LT(box.sizes().y(), 0.36 * height_m);
  }
}

TEST(Person, LooksWhereItIsHeaded) {
  // Toes reach farther forward than heels and back reach backward.
  for (const double heading_rad : {0.0, 1.0, 2.5, -2.0}) {
    const TriangleMesh mesh = person_in({.heading_rad = heading_rad});
    const Vector3d ahead(std::cos(heading_rad), std::sin(heading_rad), 0);
    double front_m = 0;
    double back_m = 0;
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      front_m = std::max(front_m, vertex.cast<double>().dot(ahead));
      back_m = std::min(back_m, vertex.cast<double>().dot(ahead));
    }
    EXPECT_GT(front_m, 1.3 * -back_m) << heading_rad;
  }
}

TEST(Person, LeavesNoFootprintBehindWhileALegStands) {
  // In the middle of the stance of the left leg, the hips pass over the foot: it moves backward
  // relative to the hips as fast as the hips move forward.
  const double half = 0.1;
  const auto sole_x_m = [](double gait_rad) {
    const TriangleMesh mesh = person_in({.gait_rad = gait_rad, .swing_rad = max_swing_rad});
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      if (vertex.z() > 0.02F) continue;
      sum += vertex.cast<double>();
      ++count;
    }
    return sum.x() / count;
  };
  const double back_m = sole_x_m(std::numbers::pi - half) - sole_x_m(std::numbers::pi + half);
  const double walked_m = stride_m({}) * 2 * half / (2 * std::numbers::pi);
  // Half a step at full swing covers π/2 of the phase: the leg is faster in the middle by that.
  EXPECT_NEAR(back_m / walked_m, std::numbers::pi / 2, 0.2);
}

TEST(Person, IsMadeOfClosedSurfaces) {
  const TriangleMesh mesh = person_in({.gait_rad = 0.7, .swing_rad = max_swing_rad});
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

}  // namespace
}  // namespace tofmap
