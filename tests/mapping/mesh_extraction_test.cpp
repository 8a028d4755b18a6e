// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/mesh_extraction.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3f;

constexpr double voxel_m = 0.05;

void add(MapCloud& map, const Vector3f& point_m, const Vector3f& normal) {
  MapPoint point{};
  point.getVector3fMap() = point_m;
  point.getNormalVector3fMap() = normal;
  point.confidence = 1;
  point.observations = 5;
  map.push_back(point);
}

/// Points all over a sphere, normals outwards, about one a voxel.
MapCloud sphere(float radius_m, float noise_m = 0) {
  MapCloud map;
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, noise_m);
  const auto count =
      static_cast<int>(4 * std::numbers::pi * radius_m * radius_m / (voxel_m * voxel_m));
  // Evenly along a spiral (Fibonacci's).
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1 - z * z);
    const Vector3f normal(static_cast<float>(r * std::cos(angle)),
                          static_cast<float>(r * std::sin(angle)), static_cast<float>(z));
    add(map, (radius_m + noise(random)) * normal, normal);
  }
  return map;
}

/// A square of points at this height, normals up or down.
void add_square(MapCloud& map, float side_m, float height_m, float up) {
  for (float x = 0; x < side_m; x += static_cast<float>(voxel_m)) {
    for (float y = 0; y < side_m; y += static_cast<float>(voxel_m)) {
      add(map, {x, y, height_m}, {0, 0, up});
    }
  }
}

/// How many triangles each edge belongs to.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges(const SurfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> counts;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      ++counts[{low, high}];
    }
  }
  return counts;
}

TEST(ExtractMesh, LiesOnTheSurface) {
  const SurfaceMesh mesh = extract_mesh(sphere(1), voxel_m);
  ASSERT_GT(mesh.points_m.size(), 3000U);
  for (std::size_t i = 0; i < mesh.points_m.size(); ++i) {
    // Tangent planes lie outside: by a quarter of half the squared reach of two voxels, on average.
    EXPECT_NEAR(mesh.points_m[i].norm(), 1 + 2 * voxel_m * voxel_m / 4, 0.02 * voxel_m);
    EXPECT_GT(mesh.normals[i].dot(mesh.points_m[i].normalized()), 0.99);
  }
}

TEST(ExtractMesh, IsClosedWhereTheMapIs) {
  const SurfaceMesh mesh = extract_mesh(sphere(1), voxel_m);
  ASSERT_GT(mesh.triangles.size(), 3000U);
  const auto counts = edges(mesh);
  for (const auto& [edge, count] : counts) EXPECT_EQ(count, 2);
  // Euler's formula for a sphere: V - E + F = 2.
  EXPECT_EQ(mesh.points_m.size() + mesh.triangles.size(), counts.size() + 2);
}

TEST(ExtractMesh, TurnsTrianglesTowardsTheNormals) {
  const SurfaceMesh mesh = extract_mesh(sphere(1), voxel_m);
  ASSERT_GT(mesh.triangles.size(), 3000U);
  for (const auto& triangle : mesh.triangles) {
    const Vector3f& a = mesh.points_m[triangle[0]];
    const Vector3f across = (mesh.points_m[triangle[1]] - a).cross(mesh.points_m[triangle[2]] - a);
    EXPECT_GT(across.dot(a), 0);
  }
}

TEST(ExtractMesh, AveragesNoise) {
  const float noise_m = 0.01F;
  const SurfaceMesh mesh = extract_mesh(sphere(1, noise_m), voxel_m);
  double sum2 = 0;
  for (const Vector3f& point : mesh.points_m) sum2 += std::pow(point.norm() - 1, 2);
  EXPECT_LT(std::sqrt(sum2 / static_cast<double>(mesh.points_m.size())), 0.7 * noise_m);
}

TEST(ExtractMesh, LeavesHolesOpen) {
  MapCloud map;
  add_square(map, 1, 0.01F, 1);
  MapCloud with_hole;
  for (const MapPoint& point : map) {
    if (std::hypot(point.x - 0.5F, point.y - 0.5F) > 0.2F) with_hole.push_back(point);
  }
  const SurfaceMesh mesh = extract_mesh(with_hole, voxel_m);
  ASSERT_GT(mesh.points_m.size(), 200U);
  for (const Vector3f& point : mesh.points_m) {
    EXPECT_GT(std::hypot(point.x() - 0.5F, point.y() - 0.5F), 0.2F - 1.5F * voxel_m);
  }
}

TEST(ExtractMesh, TakesOneSideOfAThinPanel) {
  MapCloud map;
  add_square(map, 1, 0.01F, 1);
  add_square(map, 1, -0.02F, -1);
  const SurfaceMesh mesh = extract_mesh(map, voxel_m);
  ASSERT_FALSE(mesh.points_m.empty());
  for (std::size_t i = 0; i < mesh.points_m.size(); ++i) {
    EXPECT_NEAR(mesh.points_m[i].z(), 0.01, 1e-3);
    EXPECT_GT(mesh.normals[i].z(), 0.9) << "the side that came first";
  }
}

TEST(ExtractMesh, OfAnEmptyMapIsEmpty) { EXPECT_TRUE(extract_mesh({}, voxel_m).triangles.empty()); }

TEST(ExtractMesh, RefusesVoxelsTooSmallForTheExtent) {
  MapCloud map;
  add(map, {50000, 0, 0}, {0, 0, 1});
  EXPECT_THROW(extract_mesh(map, 0.002), UsageError);
}

TEST(WriteMesh, WritesWhatItsHeaderSays) {
  const test::TemporaryFolder folder;
  const SurfaceMesh mesh = extract_mesh(sphere(0.3F), voxel_m);
  ASSERT_FALSE(mesh.triangles.empty());
  write_mesh(folder.path() / "mesh.ply", mesh);
  std::ifstream in(folder.path() / "mesh.ply", std::ios::binary);
  std::size_t header = 0;
  for (std::string line; line != "end_header" && std::getline(in, line);) header += line.size() + 1;
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "mesh.ply"),
            header + 24 * mesh.points_m.size() + 13 * mesh.triangles.size());
  EXPECT_THROW(write_mesh(folder.path() / "nowhere" / "mesh.ply", mesh), InputError);
}

}  // namespace
}  // namespace tofmap
