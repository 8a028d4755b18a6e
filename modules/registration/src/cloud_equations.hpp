// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_equations.hpp"

#include <vector>

namespace tofmap {

/// A correspondence of ICP: a source point, its difference from the paired target point, and the
/// information about that difference, along the target's axes about a local origin.
struct PointPair {
  Eigen::Vector3d point_m;       ///< source point, relative to the origin
  Eigen::Vector3d difference_m;  ///< source point − target point
  Eigen::Matrix3d information;   ///< inverse covariance of `difference_m`

  double mahalanobis_distance() const {
    return std::sqrt(difference_m.dot(information * difference_m));
  }
};

/// Derivative of `difference_m` with respect to the twist: [−[point]ₓ  1].
Eigen::Matrix<double, 3, 6> difference_jacobian(const PointPair& pair);

/// Information of a pair in generalised ICP: both points scatter about their place on a plane with
/// a standard deviation of `sigma_m` along the normal and of `spread_m` along the plane.
Eigen::Matrix3d plane_to_plane_information(const Eigen::Vector3d& source_normal,
                                           const Eigen::Vector3d& target_normal, double sigma_m,
                                           double spread_m);
/// Information of a pair in point-to-plane ICP: along the target's normal only, where both points
/// have a standard deviation of `sigma_m`.
Eigen::Matrix3d point_to_plane_information(const Eigen::Vector3d& target_normal, double sigma_m);

/// Robust standard deviation of the Mahalanobis distances: 1.4826 times their median, and at least
/// `least`.
double robust_scale(const std::vector<PointPair>& pairs, double least);

/// Gauss-Newton system of the pairs, weighted by a Geman-McClure kernel. `kernel_width` is a
/// Mahalanobis distance.
NormalEquations build_equations(const std::vector<PointPair>& pairs, double kernel_width);

}  // namespace tofmap
