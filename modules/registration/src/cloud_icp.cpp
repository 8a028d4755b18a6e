// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/cloud_icp.hpp"

#include "cloud_equations.hpp"
#include "pcl_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr int max_iterations = 40;
constexpr int min_pairs = 30;
constexpr double kernel_width = 3;  // in robust standard deviations

/// Standard deviation of points from the plane through their neighbours in a voxel grid, in voxels.
/// Mahalanobis distances refer to it. Only its ratio to one voxel, the spread along the plane,
/// affects the result, since the scale of the kernel comes from the residuals.
constexpr double sigma_per_voxel = 0.03;
constexpr double least_scale = 0.1;  // keeps the scale positive for identical clouds

/// Number of pairs that count as one independent observation: the normals of neighbouring points
/// are estimated from the same points, so their errors are correlated.
constexpr double correlated_observations = 12;

constexpr std::size_t fit_points = 5000;  // enough for a share that is accurate to one percent

constexpr double max_pairing_normal_cos = 0.7071;  // 45°
constexpr double max_surface_normal_cos = 0.866;   // 30°

bool is_small(const Vector6d& twist, double voxel_m, double lever_m) {
  constexpr double tolerance_per_voxel = 1e-3;
  return lever_m * twist.head<3>().norm() + twist.tail<3>().norm() < tolerance_per_voxel * voxel_m;
}

/// A source point and the nearest target point.
struct Nearest {
  Eigen::Vector3d point_m;           ///< source point, in the target's frame
  Eigen::Vector3d normal;            ///< normal of the source point, in the target's frame
  std::optional<std::size_t> index;  ///< of the target point; empty if none is near enough
};

/// The nearest target point within `max_distance_m` for each of at most `max_points` source points,
/// which are taken at even intervals.
std::vector<Nearest> nearest_points(const OrientedCloud& source, const OrientedCloud& target,
                                    const Pose& target_from_source, double max_distance_m,
                                    std::size_t max_points) {
  const std::size_t points = std::min(source.size(), max_points);
  std::vector<Nearest> nearest(points);
  const int count = static_cast<int>(points);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * source.size() / points;
    Nearest& one = nearest[i];
    one.point_m = target_from_source * source.points_m[at].cast<double>();
    one.normal = target_from_source.linear() * source.normals[at].cast<double>();
    const auto found = target.search.nearest(one.point_m.cast<float>(), max_distance_m);
    if (found) one.index = found->index;
  }
  return nearest;
}

std::vector<PointPair> find_pairs(const OrientedCloud& source, const OrientedCloud& target,
                                  const Pose& target_from_source, const Eigen::Vector3d& origin_m,
                                  const CloudIcpOptions& options) {
  const double sigma_m = sigma_per_voxel * target.voxel_m;
  std::vector<PointPair> pairs;
  for (const Nearest& one : nearest_points(source, target, target_from_source,
                                           options.max_distance_m, options.max_points)) {
    if (!one.index) continue;
    const Eigen::Vector3d normal = target.normals[*one.index].cast<double>();
    if (std::abs(normal.dot(one.normal)) < max_pairing_normal_cos) continue;
    PointPair pair;
    pair.point_m = one.point_m - origin_m;
    pair.difference_m = one.point_m - target.points_m[*one.index].cast<double>();
    pair.information =
        options.method == CloudMethod::point_to_plane
            ? point_to_plane_information(normal, sigma_m)
            : plane_to_plane_information(one.normal, normal, sigma_m, target.voxel_m);
    pairs.push_back(pair);
  }
  return pairs;
}

double root_mean_square_radius(const std::vector<PointPair>& pairs) {
  double sum = 0;
  for (const PointPair& pair : pairs) sum += pair.point_m.squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

Eigen::Vector3d centre_of(const OrientedCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : cloud.points_m) sum += point.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

/// The pose after a rotation about `centre_m` and a translation, both along the target's axes.
Pose moved(const Pose& pose, const Vector6d& twist, const Eigen::Vector3d& centre_m) {
  const Pose step = pose_from_twist(twist);
  Pose out;
  out.linear() = step.linear() * pose.linear();
  out.translation() =
      step.linear() * (pose.translation() - centre_m) + centre_m + step.translation();
  return out;
}

/// A Gauss-Newton increment.
struct Step {
  Vector6d twist;
  double lever_m = 0;  ///< RMS distance of the paired points from the centre of rotation
};

/// Computes the Gauss-Newton increment at the pose of `result`, and sets the covariance and the
/// direction shares of `result`. Empty if too few points are paired or a value is not finite.
std::optional<Step> linearise(const OrientedCloud& source, const OrientedCloud& target,
                              const Eigen::Vector3d& source_centre_m,
                              const CloudIcpOptions& options, CloudIcpResult& result) {
  const Eigen::Vector3d centre_m = result.target_from_source * source_centre_m;
  const std::vector<PointPair> pairs =
      find_pairs(source, target, result.target_from_source, centre_m, options);
  if (pairs.size() < min_pairs) return std::nullopt;
  const double scale = robust_scale(pairs, least_scale);
  NormalEquations equations = build_equations(pairs, kernel_width * scale);
  Step step;
  step.lever_m = root_mean_square_radius(pairs);
  result.direction_shares = observability(equations, step.lever_m).shares;
  // Keeps the system solvable: the pose does not move in a direction that no pair constrains.
  constexpr double nearly_nothing = 1e-9;
  equations.information.diagonal() *= 1 + nearly_nothing;
  const Eigen::LDLT<Matrix6d> solver(equations.information);
  step.twist = -solver.solve(equations.gradient);
  result.covariance = correlated_observations * scale * scale * solver.solve(Matrix6d::Identity());
  if (!step.twist.allFinite() || !result.covariance.allFinite()) return std::nullopt;
  return step;
}

}  // namespace

std::span<const NamedValue<CloudMethod>> named_values(CloudMethod) {
  static constexpr std::array<NamedValue<CloudMethod>, 4> methods{
      {{"generalised", CloudMethod::generalised},
       {"point_to_plane", CloudMethod::point_to_plane},
       {"pcl_icp", CloudMethod::pcl_icp},
       {"pcl_gicp", CloudMethod::pcl_gicp}}};
  return methods;
}

CloudIcpResult align_clouds(const OrientedCloud& source, const OrientedCloud& target,
                            const Pose& target_from_source, const CloudIcpOptions& options) {
  CloudIcpResult result;
  result.target_from_source = target_from_source;
  const Eigen::Vector3d source_centre_m = centre_of(source);
  if (options.method == CloudMethod::pcl_icp || options.method == CloudMethod::pcl_gicp) {
    const PclAlignment found =
        align_with_pcl(source.points_m, target.points_m, target_from_source, options.max_distance_m,
                       options.method == CloudMethod::pcl_gicp, max_iterations);
    result.target_from_source = found.target_from_source;
    result.converged = found.converged;
    linearise(source, target, source_centre_m, options, result);
    return result;
  }
  while (result.iterations < max_iterations && !result.converged) {
    const std::optional<Step> step = linearise(source, target, source_centre_m, options, result);
    if (!step) return result;
    const Eigen::Vector3d centre_m = result.target_from_source * source_centre_m;
    result.target_from_source = moved(result.target_from_source, step->twist, centre_m);
    result.converged = is_small(step->twist, target.voxel_m, step->lever_m);
    ++result.iterations;
  }
  return result;
}

CloudFit measure_fit(const OrientedCloud& source, const OrientedCloud& target,
                     const Pose& target_from_source) {
  const double near_m = 2.5 * target.voxel_m;
  const double on_surface_m = 0.5 * target.voxel_m;
  int near = 0;
  int inliers = 0;
  double squares_m2 = 0;
  const std::vector<Nearest> points =
      nearest_points(source, target, target_from_source, near_m, fit_points);
  for (const Nearest& one : points) {
    if (!one.index) continue;
    ++near;
    const Eigen::Vector3d normal = target.normals[*one.index].cast<double>();
    const double off_m = normal.dot(one.point_m - target.points_m[*one.index].cast<double>());
    if (std::abs(off_m) > on_surface_m) continue;
    if (std::abs(normal.dot(one.normal)) < max_surface_normal_cos) continue;
    ++inliers;
    squares_m2 += off_m * off_m;
  }
  CloudFit fit;
  if (near == 0) return fit;
  fit.overlap = static_cast<double>(near) / static_cast<double>(points.size());
  fit.inlier_ratio = static_cast<double>(inliers) / near;
  if (inliers > 0) fit.rmse_m = std::sqrt(squares_m2 / inliers);
  return fit;
}

}  // namespace tofmap
