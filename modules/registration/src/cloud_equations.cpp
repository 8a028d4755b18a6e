// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_equations.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <tofmap/core/median.hpp>

namespace tofmap {

Eigen::Matrix<double, 3, 6> difference_jacobian(const PointPair& pair) {
  const Eigen::Vector3d& p = pair.point_m;
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << 0, p.z(), -p.y(), 1, 0, 0,  //
      -p.z(), 0, p.x(), 0, 1, 0,          //
      p.y(), -p.x(), 0, 0, 0, 1;
  return jacobian;
}

Eigen::Matrix3d plane_to_plane_information(const Eigen::Vector3d& source_normal,
                                           const Eigen::Vector3d& target_normal, double sigma_m,
                                           double spread_m) {
  const double along = spread_m * spread_m;
  const double less_across = along - sigma_m * sigma_m;
  const Eigen::Matrix3d covariance = 2 * along * Eigen::Matrix3d::Identity() -
                                     less_across * (source_normal * source_normal.transpose() +
                                                    target_normal * target_normal.transpose());
  return covariance.inverse();
}

Eigen::Matrix3d point_to_plane_information(const Eigen::Vector3d& target_normal, double sigma_m) {
  return target_normal * target_normal.transpose() / (2 * sigma_m * sigma_m);
}

double robust_scale(const std::vector<PointPair>& pairs, double least) {
  if (pairs.empty()) return least;
  std::vector<double> deviations(pairs.size());
  std::ranges::transform(pairs, deviations.begin(), &PointPair::mahalanobis_distance);
  return std::max(least, sigma_of_median_deviation * median(deviations));
}

NormalEquations build_equations(const std::vector<PointPair>& pairs, double kernel_width) {
  NormalEquations equations;
  for (const PointPair& pair : pairs) {
    const double weight = geman_mcclure_weight(pair.mahalanobis_distance(), kernel_width);
    const Eigen::Matrix<double, 3, 6> jacobian = difference_jacobian(pair);
    const Eigen::Matrix3d information = weight * pair.information;
    equations.information += jacobian.transpose() * information * jacobian;
    equations.gradient += jacobian.transpose() * (information * pair.difference_m);
    equations.weight_sum += information.trace();
  }
  return equations;
}

}  // namespace tofmap
