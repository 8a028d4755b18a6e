// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/surface_map.hpp"

#include "grid_key.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <tofmap/core/bytes.hpp>

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

SurfaceMap::SurfaceMap(const SurfaceMapOptions& options) : options_(options) { note_change(); }

void SurfaceMap::note_change() {
  static std::atomic<std::uint64_t> revisions{0};
  revision_ = ++revisions;
}

std::int64_t SurfaceMap::key(const Eigen::Vector3d& point_m) const {
  // Clamping keeps coordinates within int, but outside the grid, so that grid_key() refuses them.
  const Eigen::Array3d place = (point_m.array() / options_.voxel_m)
                                   .floor()
                                   .max(-2.0 * grid_axis_half)
                                   .min(2.0 * grid_axis_half);
  return grid_key(place.cast<int>().matrix(), options_.voxel_m);
}

Eigen::Vector3d SurfaceMap::centre_m(std::int64_t key) const {
  return options_.voxel_m * (grid_place(key).cast<double>().array() + 0.5).matrix();
}

Eigen::Vector3d SurfaceMap::mean_m(std::int64_t key, const Voxel& voxel) const {
  return centre_m(key) + (voxel.weighted_offset_m / voxel.weight).cast<double>();
}

void SurfaceMap::integrate(const SurfaceCloud& cloud, const Pose& world_from_camera) {
  note_change();
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_normal()) continue;
    const Eigen::Vector3d in_camera = point.getVector3fMap().cast<double>();
    const Eigen::Vector3d normal = point.getNormalVector3fMap().cast<double>();
    const double sigma = point.sigma_m * std::abs(normal.dot(in_camera.normalized()));
    if (!(sigma <= options_.max_sigma_m)) continue;
    const Eigen::Vector3d in_world = world_from_camera * in_camera;
    const double weight = point.confidence / std::max(sigma * sigma, min_sigma_m * min_sigma_m);
    const std::int64_t place = key(in_world);
    Voxel& voxel = voxels_[place];
    voxel.weighted_offset_m += (weight * (in_world - centre_m(place))).cast<float>();
    voxel.weighted_normal += (weight * (world_from_camera.linear() * normal)).cast<float>();
    voxel.weight += static_cast<float>(weight);
    voxel.confidence += point.confidence;
    ++voxel.observations;
  }
}

void SurfaceMap::add(const SurfaceMap& submap, const Pose& world_from_submap, int recording) {
  note_change();
  // In the order of the grid, since the order of the hash table depends on the order of insertion.
  for (const std::int64_t place : sorted_keys(submap.voxels_)) {
    const Voxel& voxel = submap.voxels_.at(place);
    if (!(voxel.weight > 0)) continue;
    const Eigen::Vector3d in_world = world_from_submap * submap.mean_m(place, voxel);
    const std::int64_t own_place = key(in_world);
    Voxel& own = voxels_[own_place];
    const auto seen_in = static_cast<std::uint32_t>(recording);
    own.recording = own.observations == 0 ? seen_in : std::min(own.recording, seen_in);
    own.weighted_offset_m += voxel.weight * (in_world - centre_m(own_place)).cast<float>();
    own.weighted_normal += world_from_submap.linear().cast<float>() * voxel.weighted_normal;
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
    point.getVector3fMap() = mean_m(place, voxel).cast<float>();
    point.data[3] = 1;
    point.getNormalVector3fMap() = voxel.weighted_normal.normalized();
    point.data_n[3] = 0;
    point.confidence = voxel.confidence / static_cast<float>(voxel.observations);
    point.observations = voxel.observations;
    point.recording = voxel.recording;
    map.push_back(point);
  }
  return map;
}

std::string SurfaceMap::to_bytes() const {
  ByteWriter out;
  for (const std::int64_t place : sorted_keys(voxels_)) {
    const Voxel& voxel = voxels_.at(place);
    out.number(place);
    for (const float number : voxel.weighted_offset_m) out.number(number);
    for (const float number : voxel.weighted_normal) out.number(number);
    out.number(voxel.weight);
    out.number(voxel.confidence);
    out.number(voxel.observations);
  }
  return out.take();
}

SurfaceMap surface_from_bytes(std::string_view bytes, const SurfaceMapOptions& options) {
  constexpr std::size_t voxel_bytes =
      sizeof(std::int64_t) + 8 * sizeof(float) + sizeof(std::uint32_t);
  constexpr float rounding = 1e-3F;
  SurfaceMap surface(options);
  ByteReader in(bytes);
  for (std::size_t left = bytes.size(); left > 0; left -= std::min(left, voxel_bytes)) {
    const auto place = in.number<std::int64_t>();
    SurfaceMap::Voxel voxel;
    for (float& number : voxel.weighted_offset_m) number = in.number<float>();
    for (float& number : voxel.weighted_normal) number = in.number<float>();
    voxel.weight = in.number<float>();
    voxel.confidence = in.number<float>();
    voxel.observations = in.number<std::uint32_t>();
    // The mean of points may be beyond the border of their voxel by rounding.
    const float reach_m = static_cast<float>(options.voxel_m) * (0.5F + rounding);
    if (voxel.weight > 0 &&
        !(voxel.weighted_offset_m.lpNorm<Eigen::Infinity>() <= voxel.weight * reach_m)) {
      throw InputError("the points of a voxel are not in it");
    }
    if (voxel.weight < 0 || voxel.observations == 0) throw InputError("a voxel has no observation");
    if (!surface.voxels_.try_emplace(place, voxel).second) throw InputError("a voxel occurs twice");
  }
  return surface;
}

}  // namespace tofmap
