// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "change_noise.hpp"

#include "grid_key.hpp"
#include "near_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace tofmap {
namespace {

constexpr float least_cosine = 0.5F;  // between the normals of one surface

/// How far points around a point are compared with it, in voxels.
constexpr float around_voxels = 4;

/// One point for each voxel: that with the most observations.
MapCloud one_for_each_voxel(const MapCloud& points, double voxel_m) {
  std::unordered_map<std::int64_t, std::size_t> place_of;
  MapCloud kept;
  for (const MapPoint& point : points) {
    const Eigen::Vector3i voxel =
        (point.getVector3fMap() / static_cast<float>(voxel_m)).array().floor().cast<int>();
    const auto [place, is_new] = place_of.try_emplace(grid_key(voxel, voxel_m), kept.size());
    if (is_new) {
      kept.push_back(point);
    } else if (point.observations > kept[place->second].observations) {
      kept[place->second] = point;
    }
  }
  return kept;
}

/// Whether another point, in front of a point or behind it, was observed clearly more often: that
/// is where the surface is, and the point is what the noise of ranges adds to it.
bool is_noise_of_another(const MapPoint& point, const MapCloud& points, const NearPoints& search,
                         float voxel_m, float farthest_m) {
  constexpr std::uint32_t clearly = 2;  // times
  const Eigen::Vector3f normal = point.getNormalVector3fMap();
  return search.any_near(point, [&](std::size_t i) {
    const MapPoint& other = points[i];
    if (other.observations <= clearly * point.observations) return false;
    const Eigen::Vector3f apart_m = other.getVector3fMap() - point.getVector3fMap();
    const float along_m = std::abs(normal.dot(apart_m));
    // Beside the point, in the same layer, voxels may have been observed more often as well.
    const bool is_beside = along_m <= voxel_m / 2 || normal.cross(apart_m).norm() >= along_m;
    return !is_beside && along_m <= farthest_m &&
           normal.dot(other.getNormalVector3fMap()) > least_cosine;
  });
}

/// The points around a point.
struct Surroundings {
  std::uint32_t usual_observations = 0;  ///< median
  int beside = 0;                        ///< number of those that continue its surface
};

Surroundings surroundings_of(const MapPoint& point, const MapCloud& points,
                             const NearPoints& search, float voxel_m) {
  Surroundings around;
  std::vector<std::uint32_t> observations;
  const Eigen::Vector3f normal = point.getNormalVector3fMap();
  search.any_near(point, [&](std::size_t i) {
    const MapPoint& other = points[i];
    observations.push_back(other.observations);
    const Eigen::Vector3f apart_m = other.getVector3fMap() - point.getVector3fMap();
    const bool is_beside = std::abs(normal.dot(apart_m)) <= voxel_m &&
                           normal.dot(other.getNormalVector3fMap()) > least_cosine;
    around.beside += is_beside ? 1 : 0;
    return false;
  });
  const auto middle = observations.begin() + std::ssize(observations) / 2;
  std::ranges::nth_element(observations, middle);
  around.usual_observations = *middle;
  return around;
}

}  // namespace

ChangedPoints without_noise(const ChangedPoints& changed, const SurfaceMapOptions& options) {
  constexpr double hardly = 1.5;  // times the least number of observations
  constexpr double share = 0.4;   // of the voxels of a surface that is whole around the point
  constexpr double sigmas = 1.5;  // of the noise of ranges
  const MapCloud& points = changed.points;
  const auto voxel_m = static_cast<float>(options.voxel_m);
  const MapCloud thinned = one_for_each_voxel(points, options.voxel_m);
  const NearPoints around(thinned, around_voxels * voxel_m);
  const auto noise_m = static_cast<float>(sigmas * options.max_sigma_m);
  const NearPoints along_ray(points, std::sqrt(2.0F) * noise_m);
  const double few = hardly * options.min_observations;
  const double scattered = share * M_PI * around_voxels * around_voxels;
  std::vector<char> is_noise(points.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t at = 0; at < std::ssize(points); ++at) {
    const auto i = static_cast<std::size_t>(at);
    const auto [usual, beside] = surroundings_of(points[i], thinned, around, voxel_m);
    const bool is_scattered = usual < few && beside < scattered;
    is_noise[i] =
        is_scattered || is_noise_of_another(points[i], points, along_ray, voxel_m, noise_m) ? 1 : 0;
  }
  ChangedPoints kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_noise[i] == 0) kept.add(points[i], changed.is_seed[i] != 0);
  }
  return kept;
}

}  // namespace tofmap
