// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap {

/// How points are drawn to surfaces.
enum class CloudMethod {
  generalised,     ///< plane to plane (Segal, Haehnel, Thrun, RSS 2009)
  point_to_plane,  ///< Chen and Medioni 1991
  pcl_icp,         ///< PCL's point-to-point, for comparison
  pcl_gicp,        ///< PCL's generalised ICP, for comparison
};

/// Which is called "generalised", "point_to_plane", "pcl_icp", "pcl_gicp". Throws UsageError for
/// other names.
CloudMethod cloud_method(const std::string& name);

struct CloudIcpOptions {
  CloudMethod method = CloudMethod::generalised;
  double max_distance_m = 0;       ///< farther apart points are no pair; must be positive
  std::size_t max_points = 20000;  ///< of the source that take part, evenly drawn
};

/// How well one cloud lies on another.
struct CloudFit {
  double overlap = 0;       ///< share of the source's points that have a target point near
  double inlier_ratio = 0;  ///< share of those that lie on its surface
  double rmse_m = 0;        ///< point to plane, over the inliers
};

struct CloudIcpResult {
  Pose target_from_source = Pose::Identity();
  bool converged = false;
  int iterations = 0;
  /// Of the twist: rotation vector about the source's centre, radians; translation, metres; both
  /// along the target's axes. For PCL's methods as generalised ICP has it at their pose.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Shares of the observations that constrain each direction, ascending: 0 (free) … 1, rotations
  /// measured at the overlap's typical radius.
  Eigen::Matrix<double, 6, 1> direction_shares = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Moves the source onto the target from near by: each point is paired with the nearest one of the
/// target, near enough and with a normal within 45 degrees, and the sum of their
/// robust Mahalanobis distances is lowered by Gauss-Newton steps in double precision about the
/// source's centre (Geman-McClure, its scale from the median). The result is the same for any
/// number of threads.
CloudIcpResult align_clouds(const OrientedCloud& source, const OrientedCloud& target,
                            const Pose& target_from_source, const CloudIcpOptions& options);

/// Near is within two and a half voxels, on the surface within half a voxel of its plane with a
/// normal within 30 degrees.
CloudFit measure_fit(const OrientedCloud& source, const OrientedCloud& target,
                     const Pose& target_from_source);

}  // namespace tofmap
