// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "moved_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <tofmap/registration/cloud_icp.hpp>

namespace tofmap {
namespace {

/// Smallest share of the points of either surface that must lie on the other one. Of a box that was
/// seen from different corners, one of three sides may be common.
constexpr double least_fit = 0.3;

/// Largest difference of the heights of a thing that was moved on the same floor.
constexpr double most_height_difference_m = 0.1;

/// Number of points that tell a shape.
constexpr std::size_t most_points = 250;

/// Some points of a map, with the spacing that they have.
OrientedCloud oriented(const MapCloud& map, double voxel_m) {
  const std::size_t step = 1 + (map.size() - 1) / most_points;
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t i = 0; i < map.size(); i += step) {
    points_m.emplace_back(map[i].getVector3fMap());
    normals.emplace_back(map[i].getNormalVector3fMap());
  }
  PointSearch search(points_m);
  return {std::move(points_m), std::move(normals), voxel_m * std::sqrt(static_cast<double>(step)),
          std::move(search)};
}

Eigen::Vector3d centroid_of(const OrientedCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point_m : cloud.points_m) sum += point_m.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

/// The height that all but a few points of a surface are below.
double top_of(const OrientedCloud& cloud, const Eigen::Vector3d& up) {
  std::vector<double> heights_m;
  for (const Eigen::Vector3f& point_m : cloud.points_m) {
    heights_m.push_back(up.dot(point_m.cast<double>()));
  }
  const auto place = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() * 49 / 50);
  std::ranges::nth_element(heights_m, place);
  return *place;
}

double share_on(const OrientedCloud& source, const OrientedCloud& target, const Pose& pose) {
  const CloudFit fit = measure_fit(source, target, pose);
  return fit.overlap * fit.inlier_ratio;
}

}  // namespace

std::optional<MovedShape> find_motion(const MapCloud& before, const MapCloud& after,
                                      const Eigen::Vector3d& up, double voxel_m) {
  const OrientedCloud source = oriented(before, voxel_m);
  const OrientedCloud target = oriented(after, voxel_m);
  if (std::abs(top_of(source, up) - top_of(target, up)) > most_height_difference_m) {
    return std::nullopt;
  }
  const Eigen::Vector3d from_m = centroid_of(source);
  const Eigen::Vector3d to_m = centroid_of(target);
  constexpr int turns = 12;
  constexpr double reach_m = 0.3;  // sides that only one recording saw move the centroid
  std::optional<MovedShape> best;
  for (int turn = 0; turn < turns; ++turn) {
    Pose start = Pose::Identity();
    start.linear() = Eigen::AngleAxisd(2 * M_PI * turn / turns, up).toRotationMatrix();
    start.translation() = to_m - start.linear() * from_m;
    const Pose pose =
        align_clouds(source, target, start, {.max_distance_m = reach_m}).target_from_source;
    const double fit =
        std::min(share_on(source, target, pose), share_on(target, source, pose.inverse()));
    if (fit >= least_fit && (!best || fit > best->fit)) best = MovedShape{pose, fit};
  }
  return best;
}

}  // namespace tofmap
