// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

#include <tofmap/core/named_value.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap {

/// The error metric of ICP between two clouds.
enum class CloudMethod {
  generalised,     ///< plane to plane (Segal, Haehnel, Thrun, RSS 2009)
  point_to_plane,  ///< point to plane (Chen and Medioni 1991)
  pcl_icp,         ///< PCL's point-to-point ICP, for comparison
  pcl_gicp,        ///< PCL's generalised ICP, for comparison
};

/// The names of all methods, the recommended one first.
std::span<const NamedValue<CloudMethod>> named_values(CloudMethod);

/// Options of align_clouds().
struct CloudIcpOptions {
  /// The error metric that is minimised.
  CloudMethod method = CloudMethod::generalised;
  /// Largest correspondence distance, metres: points farther apart are not paired. Has no default;
  /// must be positive.
  double max_distance_m = 0;
  /// Largest number of source points used. From a larger cloud, points are taken at even intervals.
  /// PCL's methods align all points.
  std::size_t max_points = 20000;
};

/// How well a source cloud fits a target cloud at a given pose.
struct CloudFit {
  double overlap = 0;       ///< share of the source's points that are near a target point
  double inlier_ratio = 0;  ///< share of those near points that lie on the target's surface
  double rmse_m = 0;        ///< RMS distance from point to plane over the inliers, metres
};

/// The pose that align_clouds() found.
struct CloudIcpResult {
  Pose target_from_source = Pose::Identity();
  /// False at the iteration limit or with fewer than 30 correspondences. PCL's methods count their
  /// iteration limit as convergence.
  bool converged = false;
  int iterations = 0;  ///< 0 for PCL's methods
  /// Covariance of the pose error as a twist: rotation vector about the centroid of the source,
  /// radians, then translation, metres, both along the target's axes. Comes from the last
  /// linearisation; for PCL's methods, from the system of generalised ICP at their pose. Zero if
  /// the initial pose had too few correspondences.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Share of the observations that constrain each direction of motion, in ascending order, from 0
  /// (unconstrained) to 1. Rotations are measured as the motion of points at the RMS distance of
  /// the paired points from the centroid of the source.
  Eigen::Matrix<double, 6, 1> direction_shares = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Refines the pose of `source` relative to `target` from a close initial pose by ICP.
///
/// Each source point is paired with the nearest target point within `max_distance_m` if their
/// normals are within 45 degrees of each other, regardless of sign. Gauss-Newton steps in double
/// precision about the centroid of the source minimise the Mahalanobis distances of the pairs
/// through a Geman-McClure kernel, whose width is three robust standard deviations (from the
/// median). Stops without convergence after 40 iterations, or when fewer than 30 points are paired.
/// The result is the same for any number of threads.
CloudIcpResult align_clouds(const OrientedCloud& source, const OrientedCloud& target,
                            const Pose& target_from_source, const CloudIcpOptions& options);

/// Measures the fit at a given pose on at most 5000 source points. A source point is near a target
/// point within 2.5 voxels of the target. It lies on the surface if it is also within half a voxel
/// of the plane of that target point, and both normals are within 30 degrees of each other,
/// regardless of sign. All values are 0 if no source point is near the target.
CloudFit measure_fit(const OrientedCloud& source, const OrientedCloud& target,
                     const Pose& target_from_source);

}  // namespace tofmap
