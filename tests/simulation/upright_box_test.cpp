// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "upright_box.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// A box of 2 x 1 x 0.5 m, a quarter of a half turn about the vertical.
UprightBox slanted_box() { return {{1, 2, 3}, {1, 0.5, 0.25}, std::numbers::pi / 4}; }

class RandomPoints {
 public:
  Vector3d in_cube(double half_m) {
    std::uniform_real_distribution<double> place(-half_m, half_m);
    const double x = place(random_);
    const double y = place(random_);
    return {x, y, place(random_)};
  }

  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }

 private:
  std::mt19937 random_{5};
};

/// Whether one of many points of a triangle is in a box.
bool has_point_in(const UprightBox& box, const std::array<Vector3d, 3>& triangle) {
  constexpr int steps = 60;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double a = static_cast<double>(i) / steps;
      const double b = static_cast<double>(j) / steps;
      const Vector3d point =
          triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
      if (gap_m(box, point) == 0) return true;
    }
  }
  return false;
}

UprightBox grown(UprightBox box, double margin_m) {
  box.half_m.array() += margin_m;
  return box;
}

TEST(UprightBox, TurnsPointsToItsAxesAndBack) {
  const UprightBox box = slanted_box();
  const double side_m = std::sqrt(0.5);
  EXPECT_TRUE(box.world_m({1, 0, 0.25}).isApprox(Vector3d(1 + side_m, 2 + side_m, 3.25)));
  EXPECT_TRUE(box.local_m(box.world_m({0.3, -0.2, 0.1})).isApprox(Vector3d(0.3, -0.2, 0.1)));
}

TEST(UprightBox, HasGapsToPointsOutside) {
  const UprightBox box = slanted_box();
  EXPECT_NEAR(gap_m(box, box.world_m({1.3, 0, 0.65})), 0.5, 1e-12);
  EXPECT_NEAR(horizontal_gap_m(box, box.world_m({1.3, 0, 0.65})), 0.3, 1e-12);
  EXPECT_EQ(gap_m(box, box.world_m({0.99, -0.49, 0.24})), 0);
}

TEST(UprightBox, IntersectsTheTrianglesOfWhichAPointIsInIt) {
  RandomPoints random;
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const UprightBox box{random.in_cube(0.5), {0.6, 0.3, 0.2}, 6 * random.share()};
    const std::array<Vector3d, 3> triangle{random.in_cube(1), random.in_cube(1), random.in_cube(1)};
    // Points of a triangle are at most 3 cm from the next of those that are looked at.
    if (has_point_in(box, triangle)) {
      EXPECT_TRUE(intersects(box, triangle)) << i;
      ++hits;
    } else if (!has_point_in(grown(box, 0.05), triangle)) {
      EXPECT_FALSE(intersects(box, triangle)) << i;
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 350);
}

TEST(UprightBox, IntersectsTheBoxesOfWhichAPointIsInIt) {
  RandomPoints random;
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const UprightBox a{random.in_cube(0.5), {0.6, 0.3, 0.2}, 6 * random.share()};
    const UprightBox b{random.in_cube(1), {0.2, 0.5, 0.3}, 6 * random.share()};
    const auto has_point_of = [&](const UprightBox& box) {
      constexpr int steps = 40;
      for (int j = 0; j < (steps + 1) * (steps + 1) * (steps + 1); ++j) {
        const Vector3d share(j % (steps + 1), j / (steps + 1) % (steps + 1),
                             j / (steps + 1) / (steps + 1));
        const Vector3d local = (2 * share / steps - Vector3d::Ones()).cwiseProduct(b.half_m);
        if (gap_m(box, b.world_m(local)) == 0) return true;
      }
      return false;
    };
    if (has_point_of(a)) {
      EXPECT_TRUE(intersects(a, b)) << i;
      EXPECT_TRUE(intersects(b, a)) << i;
      ++hits;
    } else if (!has_point_of(grown(a, 0.05))) {
      EXPECT_FALSE(intersects(a, b)) << i;
      EXPECT_FALSE(intersects(b, a)) << i;
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(hits, 350);
}

}  // namespace
}  // namespace tofmap
