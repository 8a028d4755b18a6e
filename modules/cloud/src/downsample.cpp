// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/downsample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>

#include <Eigen/Geometry>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

using Place = std::array<std::int64_t, 3>;

struct PlaceHash {
  std::size_t operator()(const Place& place) const {
    std::uint64_t hash = 0;
    for (const std::int64_t at : place) {
      // Multiplying by an odd number near 2⁶⁴ / golden ratio spreads each bit to higher ones.
      hash = (hash ^ static_cast<std::uint64_t>(at)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32U;
    }
    return hash;
  }
};

struct Sum {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the first point, to keep precision
  double count = 0;
};

Place place_of(const Eigen::Vector3d& point, double voxel_m) {
  const Eigen::Array3d scaled = (point.array() / voxel_m).floor();
  constexpr double most = 9.0e15;  // about 2⁵³; above it, doubles skip whole numbers
  if (!(voxel_m > 0) || !(scaled.abs() < most).all()) {
    throw UsageError("voxels of " + std::to_string(voxel_m) +
                     " m are too small for coordinates this large; choose larger voxels");
  }
  return {static_cast<std::int64_t>(scaled.x()), static_cast<std::int64_t>(scaled.y()),
          static_cast<std::int64_t>(scaled.z())};
}

}  // namespace

std::vector<Eigen::Vector3d> downsample(std::span<const Eigen::Vector3d> points, double voxel_m) {
  std::unordered_map<Place, std::size_t, PlaceHash> index;
  std::vector<Eigen::Vector3d> out;  // the first point of each voxel until the means are known
  std::vector<Sum> sums;
  for (const Eigen::Vector3d& point : points) {
    const auto [known, is_new] = index.try_emplace(place_of(point, voxel_m), out.size());
    if (is_new) {
      out.push_back(point);
      sums.emplace_back();
    }
    Sum& sum = sums[known->second];
    sum.offset += point - out[known->second];
    sum.count += 1;
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += sums[i].offset / sums[i].count;
  return out;
}

std::size_t remove_strays(std::vector<Eigen::Vector3d>& points) {
  constexpr double most_times = 20;
  if (points.empty()) return 0;
  Eigen::Vector3d middle;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(), [axis](const auto& p) { return p[axis]; });
    middle[axis] = median(values);
  }
  std::ranges::transform(points, values.begin(),
                         [&](const auto& p) { return (p - middle).norm(); });
  const auto outermost = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 19 / 20);
  std::ranges::nth_element(values, outermost);
  const double limit = most_times * *outermost;
  if (!(limit > 0)) return 0;
  return std::erase_if(points, [&](const auto& p) { return (p - middle).norm() > limit; });
}

double voxel_for_count(std::span<const Eigen::Vector3d> points, std::size_t count) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  const double extent = points.empty() ? 0 : box.diagonal().norm();
  if (!(extent > 0)) return 1;
  double low = extent * 1e-5;
  double high = extent;
  while (high / low > 1.1) {
    const double middle = std::sqrt(low * high);
    (downsample(points, middle).size() > count ? low : high) = middle;
  }
  return high;
}

}  // namespace tofmap
