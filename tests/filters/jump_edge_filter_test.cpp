// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/jump_edge_filter.hpp>

namespace tofmap {
namespace {

using test::camera;
using test::plane;
using test::slanted_plane;

constexpr double edge_angle_rad = 170 * std::numbers::pi / 180;

/// The angle at p_i as May et al. define it, in degrees, the slow way.
double angle_at_deg(const Eigen::Vector3d& p_i, const Eigen::Vector3d& p_n) {
  return std::acos((-p_i).normalized().dot((p_n - p_i).normalized())) * 180 / std::numbers::pi;
}

TEST(JumpEdgeFilter, KeepsAPlaneWhole) {
  const RangeImage out = drop_jump_edges(plane(3), pixel_rays(camera()), edge_angle_rad, 0);
  EXPECT_EQ(out.count_valid(), 20 * 16);
}

TEST(JumpEdgeFilter, KeepsAPlaneAtASlantWhole) {
  // The rays are up to 25° off the axis: at a slant of 50° they meet the plane at 15° and more.
  const RangeImage image = slanted_plane(3, 50 * std::numbers::pi / 180);
  ASSERT_TRUE((image.range_m > 0).all());
  EXPECT_EQ(drop_jump_edges(image, pixel_rays(camera()), edge_angle_rad, 0).count_valid(), 20 * 16);
}

TEST(JumpEdgeFilter, LooksAtAllEightNeighbours) {
  const PixelRays rays = pixel_rays(camera());
  for (int v = 0; v < 3; ++v) {
    for (int u = 0; u < 3; ++u) {
      if (v == 1 && u == 1) continue;
      RangeImage image = plane(3);
      image.range_m(6 + v, 8 + u) += 6;
      EXPECT_FALSE(drop_jump_edges(image, rays, edge_angle_rad, 0).valid(7, 9)) << v << ", " << u;
    }
  }
}

TEST(JumpEdgeFilter, TakesNothingFromBeyondTheBordersOfTheImage) {
  // What is far in the last column must not reach the first column of the next row.
  RangeImage image = plane(3);
  image.range_m.col(19) += 6;
  const RangeImage out = drop_jump_edges(image, pixel_rays(camera()), edge_angle_rad, 0);
  for (int v = 0; v < 16; ++v) {
    EXPECT_TRUE(out.valid(v, 0));
    EXPECT_FALSE(out.valid(v, 18));
    EXPECT_TRUE(out.valid(v, 19));
  }
}

TEST(JumpEdgeFilter, FindsEdgesInTheCorners) {
  const PixelRays rays = pixel_rays(camera());
  for (const int v : {0, 15}) {
    for (const int u : {0, 19}) {
      RangeImage image = plane(9);
      image.range_m(v, u) -= 5;
      const RangeImage out = drop_jump_edges(image, rays, edge_angle_rad, 0);
      EXPECT_FALSE(out.valid(v, u));
      EXPECT_EQ(out.count_valid(), 20 * 16 - 1);
    }
  }
}

TEST(JumpEdgeFilter, HearsNothingFromInvalidNeighbours) {
  RangeImage image = plane(3);
  image.range_m(7, 9) += 6;
  const PixelRays rays = pixel_rays(camera());
  ASSERT_EQ(drop_jump_edges(image, rays, edge_angle_rad, 0).count_valid(), 20 * 16 - 8);
  image.invalidate(7, 9, InvalidReason::low_amplitude);
  const RangeImage out = drop_jump_edges(image, rays, edge_angle_rad, 0);
  EXPECT_EQ(out.count_valid(), 20 * 16 - 1);
  EXPECT_EQ(out.reason(7, 9), static_cast<int>(InvalidReason::low_amplitude)) << "the first reason";
}

TEST(JumpEdgeFilter, RefusesRaysOfAnotherCamera) {
  CameraModel other = camera();
  other.width_px = 19;
  EXPECT_THROW(drop_jump_edges(plane(3), pixel_rays(other), edge_angle_rad, 0), UsageError);
}

TEST(JumpEdgeFilter, RemovesAFlyingPixelAndKeepsTheFartherSurface) {
  RangeImage image = plane(3);
  const RangeImage far = plane(9);
  image.range_m.rightCols(10) = far.range_m.rightCols(10);
  image.range_m.col(10) = plane(6).range_m.col(10);  // halfway between both
  const RangeImage out = drop_jump_edges(image, pixel_rays(camera()), edge_angle_rad, 0);
  for (int v = 0; v < 16; ++v) {
    EXPECT_EQ(out.reason(v, 10), static_cast<int>(InvalidReason::jump_edge));
    EXPECT_TRUE(out.valid(v, 11)) << "the first pixel of the farther surface";
    EXPECT_TRUE(out.valid(v, 8));
  }
}

TEST(JumpEdgeFilter, IsTheSlowDefinition) {
  RangeImage image = plane(3);
  for (Eigen::Index i = 0; i < image.range_m.size(); ++i) {
    image.range_m.data()[i] += 2.5F * static_cast<float>((i * 7919) % 11) / 10;
  }
  image.invalidate(5, 5, InvalidReason::no_return);
  const PixelRays rays = pixel_rays(camera());
  const RangeImage out = drop_jump_edges(image, rays, edge_angle_rad, 0);
  const auto point = [&](int v, int u) -> Eigen::Vector3d {
    return image.range_m(v, u) * Eigen::Vector3d(rays.x(v, u), rays.y(v, u), rays.z(v, u));
  };
  int removed = 0;
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 20; ++u) {
      if (!image.valid(v, u)) continue;
      double largest = 0;
      for (int r = std::max(0, v - 1); r <= std::min(15, v + 1); ++r) {
        for (int c = std::max(0, u - 1); c <= std::min(19, u + 1); ++c) {
          if ((r == v && c == u) || !image.valid(r, c)) continue;
          largest = std::max(largest, angle_at_deg(point(v, u), point(r, c)));
        }
      }
      EXPECT_EQ(!out.valid(v, u), largest > 170) << v << ", " << u << ": " << largest;
      removed += largest > 170 ? 1 : 0;
    }
  }
  EXPECT_GT(removed, 10);
}

TEST(JumpEdgeFilter, TakesNoNoiseForAnEdge) {
  RangeImage image = plane(3, 0.5F);
  image.range_m(8, 10) -= 1.5F;  // 3 σ, 2.1 σ of the difference
  const PixelRays rays = pixel_rays(camera());
  EXPECT_FALSE(drop_jump_edges(image, rays, edge_angle_rad, 0).valid(8, 10));
  EXPECT_EQ(drop_jump_edges(image, rays, edge_angle_rad, 5).count_valid(), 20 * 16);
}

}  // namespace
}  // namespace tofmap
