// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "moved_shape.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/registration/cloud_icp.hpp>

namespace tofmap {
namespace {

/// Smallest share of the points of either surface that must lie on the other one.
constexpr double least_fit = 0.6;

/// A surface cannot be another one if it has more than this many times its points.
constexpr std::size_t most_times_points = 3;

OrientedCloud oriented(const MapCloud& map, double voxel_m) {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;
  for (const MapPoint& point : map) {
    points_m.emplace_back(point.getVector3fMap());
    normals.emplace_back(point.getNormalVector3fMap());
  }
  PointSearch search(points_m);
  return {std::move(points_m), std::move(normals), voxel_m, std::move(search)};
}

Eigen::Vector3d centroid_of(const OrientedCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point_m : cloud.points_m) sum += point_m.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

double share_on(const OrientedCloud& source, const OrientedCloud& target, const Pose& pose) {
  const CloudFit fit = measure_fit(source, target, pose);
  return fit.overlap * fit.inlier_ratio;
}

}  // namespace

std::optional<MovedShape> find_motion(const MapCloud& before, const MapCloud& after,
                                      const Eigen::Vector3d& up, double voxel_m) {
  if (before.size() > most_times_points * after.size() ||
      after.size() > most_times_points * before.size()) {
    return std::nullopt;
  }
  const OrientedCloud source = oriented(before, voxel_m);
  const OrientedCloud target = oriented(after, voxel_m);
  const Eigen::Vector3d from_m = centroid_of(source);
  const Eigen::Vector3d to_m = centroid_of(target);
  constexpr int turns = 24;
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
