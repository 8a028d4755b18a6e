// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "levelled_cloud.hpp"

#include "possible_views.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/cloud/downsample.hpp>

namespace tofmap {
namespace {

constexpr std::size_t feature_points = 5000;
constexpr int level_count = 3;

/// A finer level is used only if it has at least this many times the points of the level before.
constexpr double least_growth = 1.2;

std::vector<Eigen::Vector3d> centred(const PointSet& cloud, double unit_m,
                                     const Eigen::Vector3d& centre_m) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.points.size());
  for (const Eigen::Vector3d& point : cloud.points) points.push_back(unit_m * point - centre_m);
  return points;
}

/// How many points feature_voxel() leaves. Each has a surface to itself that grows with the square
/// of the voxel size.
std::size_t points_left(const PointSet& cloud) {
  return std::clamp<std::size_t>(cloud.points.size() / 2, 1, feature_points);
}

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

double feature_voxel(const PointSet& cloud) {
  return voxel_for_count(cloud.points, points_left(cloud));
}

double extent_voxel(const PointSet& cloud, double voxel) {
  const auto left = static_cast<double>(points_left(cloud));
  return voxel * std::sqrt(left / feature_points);
}

std::optional<LevelledCloud> make_levels(const PointSet& cloud, const CloudSensor& sensor,
                                         double unit_m, double voxel_m) {
  if (cloud.points.size() < least_oriented_points) return std::nullopt;
  LevelledCloud out;
  out.centre_m = unit_m * mean(cloud.points);
  const std::vector<Eigen::Vector3d> points = centred(cloud, unit_m, out.centre_m);
  const std::vector<Eigen::Vector3d> coarse = downsample(points, voxel_m);
  std::optional<Eigen::Vector3d> sensor_m;
  if (sensor.position) sensor_m = unit_m * *sensor.position - out.centre_m;
  const Eigen::Vector3d from = sensor_m.value_or(mean(coarse));
  auto coarsest = orient(coarse, voxel_m, from);
  if (!coarsest) return std::nullopt;
  out.levels.push_back(std::move(*coarsest));
  std::size_t count = coarse.size();
  for (int level = 1; level < level_count; ++level) {
    voxel_m /= 2;
    const std::vector<Eigen::Vector3d> finer = downsample(points, voxel_m);
    if (static_cast<double>(finer.size()) < least_growth * static_cast<double>(count)) break;
    auto level_cloud = orient(finer, voxel_m, from);
    if (!level_cloud) break;
    out.levels.push_back(std::move(*level_cloud));
    count = finer.size();
  }
  if (sensor_m) {
    out.views.emplace_back(out.levels.back().points_m, *sensor_m);
  } else {
    out.views = possible_views(out.levels);
  }
  out.features = point_features(out.levels.front());
  out.neighbours = VoxelNeighbours(out.levels.front().points_m, out.levels.front().voxel_m);
  return out;
}

}  // namespace tofmap
