// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

TEST(RayScene, HitsTheNearestSurfaceAtItsExactRange) {
  TriangleMesh mesh;
  add_box(mesh, {2, -1, -1}, {3, 1, 1}, 0.25);
  add_box(mesh, {5, -9, -9}, {6, 9, 9}, 0.75);
  const RayScene scene(mesh);
  const auto hit = scene.cast({0, 0.3, 0.2}, Vector3d::UnitX(), 100);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 2, 1e-6);
  EXPECT_NEAR(hit->reflectance, 0.25, 1e-6);
  EXPECT_NEAR(hit->cos_incidence, 1, 1e-6);
  const Vector3d slanted = Vector3d(3, 4, 0).normalized();  // past the first, onto the second
  const auto beside = scene.cast({0, 0, 0}, slanted, 100);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->range_m, 5 / 0.6, 1e-5);
  EXPECT_NEAR(beside->cos_incidence, 0.6, 1e-6);
}

TEST(RayScene, HitsNothingBehindTheCameraOrBeyondTheLimit) {
  TriangleMesh mesh;
  add_box(mesh, {2, -1, -1}, {3, 1, 1}, 0.5);
  const RayScene scene(mesh);
  EXPECT_FALSE(scene.cast({0, 0, 0}, -Vector3d::UnitX(), 100));
  EXPECT_FALSE(scene.cast({0, 0, 0}, Vector3d::UnitX(), 1.9));
}

TEST(RayScene, InterpolatesReflectanceBetweenVertices) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  mesh.reflectance = {0.0F, 1.0F, 0.0F};
  mesh.triangles = {{0, 1, 2}};
  const auto hit = RayScene(mesh).cast({0, 0.3, 0.4}, Vector3d::UnitX(), 10);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->reflectance, 0.3, 1e-6);
}

TEST(RayScene, LetsNoRayOutOfAClosedBox) {
  TriangleMesh mesh;
  add_rotated_box(mesh, {-2, -3, -1}, {2, 3, 1}, 0.3, 0.5);
  const RayScene scene(mesh);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d direction =
        Vector3d(normal(random), normal(random), normal(random)).normalized();
    ASSERT_TRUE(scene.cast({0.1, 0.2, 0.3}, direction, 10)) << direction.transpose();
  }
}

/// Slow and obvious: the nearest of many points on each triangle.
double sampled_clearance_m(const TriangleMesh& mesh, const Vector3d& point) {
  constexpr int steps = 60;
  double nearest = 1e9;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Vector3d b = mesh.vertices[triangle[1]].cast<double>();
    const Vector3d c = mesh.vertices[triangle[2]].cast<double>();
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const Vector3d sample = a + (b - a) * i / steps + (c - a) * j / steps;
        nearest = std::min(nearest, (sample - point).norm());
      }
    }
  }
  return nearest;
}

TEST(RayScene, ClearanceAgreesWithDenseSampling) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto anywhere = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.push_back(anywhere().cast<float>());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh.reflectance.assign(mesh.vertices.size(), 0.5F);
  const RayScene scene(mesh);
  for (int i = 0; i < 50; ++i) {
    const Vector3d point = 1.5 * anywhere();
    const double sampled = sampled_clearance_m(mesh, point);
    // Samples lie up to 2.9 / 60 / 2 m from the nearest point, mostly across the direction to it.
    EXPECT_LE(scene.clearance_m(point, 10), sampled + 1e-5);
    EXPECT_GE(scene.clearance_m(point, 10), sampled - 0.025);
  }
}

TEST(RayScene, ClearanceEndsAtItsLimit) {
  TriangleMesh mesh;
  add_box(mesh, {5, -1, -1}, {6, 1, 1}, 0.5);
  const RayScene scene(mesh);
  EXPECT_NEAR(scene.clearance_m({0, 0, 0}, 10), 5, 1e-6);
  EXPECT_EQ(scene.clearance_m({0, 0, 0}, 2), 2);
}

TEST(RayScene, NeedsATriangle) { EXPECT_THROW(RayScene{TriangleMesh{}}, UsageError); }

}  // namespace
}  // namespace tofmap
