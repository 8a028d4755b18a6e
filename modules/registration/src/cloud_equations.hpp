// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_equations.hpp"

#include <vector>

namespace tofmap {

/// A source point, the gap to the target point it is paired with, and how surely the gap should be
/// zero in each direction; in the target's axes about a local origin.
struct PointPair {
  Eigen::Vector3d point_m;      ///< source point, relative to the origin
  Eigen::Vector3d gap_m;        ///< source − target
  Eigen::Matrix3d information;  ///< inverse covariance of the gap

  double deviation() const { return std::sqrt(gap_m.dot(information * gap_m)); }
};

/// Derivative of a gap by the twist: [−[point]ₓ  1].
Eigen::Matrix<double, 3, 6> gap_jacobian(const PointPair& pair);

/// The pair's information if both points lie on planes of that normal scatter (generalised ICP):
/// σ across the plane, `spread_m` along it. With the target's normal alone, point to plane.
Eigen::Matrix3d plane_to_plane_information(const Eigen::Vector3d& source_normal,
                                           const Eigen::Vector3d& target_normal, double sigma_m,
                                           double spread_m);
Eigen::Matrix3d point_to_plane_information(const Eigen::Vector3d& target_normal, double sigma_m);

/// 1.4826 times the median deviation, and no less than `least`.
double robust_scale(const std::vector<PointPair>& pairs, double least);

NormalEquations build_equations(const std::vector<PointPair>& pairs, double kernel_width);

}  // namespace tofmap
