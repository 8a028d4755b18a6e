// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/surface_map.hpp"

#include "grid_key.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// Smallest standard deviation used for weights. Otherwise nearly exact points would outweigh all
/// others.
constexpr double min_sigma_m = 0.001;

template <class Voxels>
std::vector<std::int64_t> sorted_keys(const Voxels& voxels) {
  std::vector<std::int64_t> keys;
  keys.reserve(voxels.size());
  for (const auto& voxel : voxels) keys.push_back(voxel.first);
  std::ranges::sort(keys);
  return keys;
}

}  // namespace

std::vector<OptionField<SurfaceMapOptions>> SurfaceMapOptions::fields() {
  using O = SurfaceMapOptions;
  return {
      {"voxel_m", &O::voxel_m, 0.002, 10, "m",
       "edge length of a voxel; each voxel becomes at most one map point"},
      {"min_observations", &O::min_observations, 1, 100000, "",
       "smallest number of observations of a voxel that becomes a map point"},
      {"max_sigma_m", &O::max_sigma_m, 0.001, 100, "m",
       "largest standard deviation, along the normal, of a point that enters the map"},
      {"drop_free_space_violations", &O::drop_free_space_violations, 0, 1, "",
       "removes points that keyframes see through: moving objects, flying pixels, wrong wrap "
       "counts"},
  };
}

SurfaceMap::SurfaceMap(const SurfaceMapOptions& options) : options_(options) {}

std::int64_t SurfaceMap::key(const Eigen::Vector3d& point_m) const {
  // Clamping keeps coordinates within int, but outside the grid, so that grid_key() refuses them.
  const Eigen::Array3d place = (point_m.array() / options_.voxel_m)
                                   .floor()
                                   .max(-2.0 * grid_axis_half)
                                   .min(2.0 * grid_axis_half);
  return grid_key(place.cast<int>().matrix(), options_.voxel_m);
}

void SurfaceMap::integrate(const SurfaceCloud& cloud, const Pose& world_from_camera) {
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_normal()) continue;
    const Eigen::Vector3d in_camera = point.getVector3fMap().cast<double>();
    const Eigen::Vector3d normal = point.getNormalVector3fMap().cast<double>();
    const double sigma = point.sigma_m * std::abs(normal.dot(in_camera.normalized()));
    if (!(sigma <= options_.max_sigma_m)) continue;
    const Eigen::Vector3d in_world = world_from_camera * in_camera;
    const double weight = point.confidence / std::max(sigma * sigma, min_sigma_m * min_sigma_m);
    Voxel& voxel = voxels_[key(in_world)];
    voxel.weighted_point_m += weight * in_world;
    voxel.weighted_normal += weight * (world_from_camera.linear() * normal);
    voxel.weight += weight;
    voxel.confidence += point.confidence;
    ++voxel.observations;
  }
}

void SurfaceMap::add(const SurfaceMap& submap, const Pose& world_from_submap) {
  // In the order of the grid, since the order of the hash table depends on the order of insertion.
  for (const std::int64_t place : sorted_keys(submap.voxels_)) {
    const Voxel& voxel = submap.voxels_.at(place);
    if (!(voxel.weight > 0)) continue;
    const Eigen::Vector3d in_world = world_from_submap * (voxel.weighted_point_m / voxel.weight);
    Voxel& own = voxels_[key(in_world)];
    own.weighted_point_m += voxel.weight * in_world;
    own.weighted_normal += world_from_submap.linear() * voxel.weighted_normal;
    own.weight += voxel.weight;
    own.confidence += voxel.confidence;
    own.observations += voxel.observations;
  }
}

MapCloud SurfaceMap::extract() const {
  MapCloud map;
  for (const std::int64_t place : sorted_keys(voxels_)) {
    const Voxel& voxel = voxels_.at(place);
    const bool has_direction = voxel.weighted_normal.norm() > 0;
    const bool is_seen = static_cast<int>(voxel.observations) >= options_.min_observations;
    if (!has_direction || !is_seen) continue;
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
