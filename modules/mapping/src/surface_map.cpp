// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/surface_map.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Grid coordinates of 21 bits an axis: at voxels of 1 cm they span 21 km.
constexpr int axis_bits = 21;
constexpr std::int64_t axis_half = std::int64_t{1} << (axis_bits - 1);

/// Averaging cannot lower a point's error below this: nearly exact points would drown all others.
constexpr double min_sigma_m = 0.001;

}  // namespace

std::vector<OptionField<SurfaceMapOptions>> SurfaceMapOptions::fields() {
  using O = SurfaceMapOptions;
  return {
      {"voxel_m", &O::voxel_m, 0.002, 10, "m", "edge of a voxel; one map point each"},
      {"min_observations", &O::min_observations, 1, 100000, "",
       "voxels with fewer points are not written"},
      {"max_sigma_m", &O::max_sigma_m, 0.001, 100, "m",
       "points less certain than this, along their normal, do not enter the map"},
  };
}

SurfaceMap::SurfaceMap(const SurfaceMapOptions& options) : options_(options) {}

std::int64_t SurfaceMap::key(const Eigen::Vector3d& point_m) const {
  std::int64_t packed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point_m[axis] / options_.voxel_m));
    if (cell < -axis_half || cell >= axis_half) {
      throw UsageError("map.voxel_m: " + std::to_string(options_.voxel_m) +
                       " m is too small for a map of this extent; choose larger voxels");
    }
    packed = (packed << axis_bits) | (cell + axis_half);
  }
  return packed;
}

void SurfaceMap::integrate(const SurfaceCloud& cloud, const Pose& world_from_camera) {
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_normal()) continue;
    const Eigen::Vector3d in_camera = point.getVector3fMap().cast<double>();
    const Eigen::Vector3d normal = point.getNormalVector3fMap().cast<double>();
    const double sigma = point.sigma_m * std::abs(normal.dot(in_camera.normalized()));
    if (!(sigma <= options_.max_sigma_m)) continue;
    const Eigen::Vector3d in_world = world_from_camera * in_camera;
    const double weight = 1 / std::max(sigma * sigma, min_sigma_m * min_sigma_m);
    Voxel& voxel = voxels_[key(in_world)];
    voxel.weighted_point_m += weight * in_world;
    voxel.weighted_normal += weight * (world_from_camera.linear() * normal);
    voxel.weight += weight;
    voxel.confidence += point.confidence;
    ++voxel.observations;
  }
}

void SurfaceMap::add(const SurfaceMap& part, const Pose& world_from_part) {
  for (const auto& [place, voxel] : part.voxels_) {
    if (!(voxel.weight > 0)) continue;
    const Eigen::Vector3d in_world = world_from_part * (voxel.weighted_point_m / voxel.weight);
    Voxel& own = voxels_[key(in_world)];
    own.weighted_point_m += voxel.weight * in_world;
    own.weighted_normal += world_from_part.linear() * voxel.weighted_normal;
    own.weight += voxel.weight;
    own.confidence += voxel.confidence;
    own.observations += voxel.observations;
  }
}

MapCloud SurfaceMap::extract() const {
  std::vector<std::int64_t> keys;
  for (const auto& [key, voxel] : voxels_) {
    const bool has_direction = voxel.weighted_normal.norm() > 0;
    const bool is_seen = static_cast<int>(voxel.observations) >= options_.min_observations;
    if (has_direction && is_seen) keys.push_back(key);
  }
  std::ranges::sort(keys);
  MapCloud map;
  map.reserve(keys.size());
  for (const std::int64_t key : keys) {
    const Voxel& voxel = voxels_.at(key);
    MapPoint point;
    point.getVector3fMap() = (voxel.weighted_point_m / voxel.weight).cast<float>();
    point.data[3] = 1;
    point.getNormalVector3fMap() = voxel.weighted_normal.normalized().cast<float>();
    point.data_n[3] = 0;
    point.confidence = static_cast<float>(voxel.confidence / voxel.observations);
    point.observations = voxel.observations;
    map.push_back(point);
  }
  return map;
}

}  // namespace tofmap
