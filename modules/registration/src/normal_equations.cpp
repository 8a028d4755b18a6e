// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <tofmap/core/median.hpp>

namespace tofmap {

Vector6d residual_jacobian(const Correspondence& pair) {
  Vector6d jacobian;
  jacobian << pair.point_m.cross(pair.normal), pair.normal;
  return jacobian;
}

double robust_scale(const std::vector<Correspondence>& pairs) {
  if (pairs.empty()) return 1;
  std::vector<double> deviations(pairs.size());
  std::ranges::transform(pairs, deviations.begin(), [](const Correspondence& pair) {
    return std::abs(pair.residual_m) / std::sqrt(pair.variance_m2);
  });
  return std::max(1.0, sigma_of_median_deviation * median(deviations));
}

double geman_mcclure_weight(double normalised_residual, double width) {
  const double ratio = 1 / (1 + (normalised_residual / width) * (normalised_residual / width));
  return ratio * ratio;
}

namespace {

/// Geman-McClure weight times confidence, divided by the predicted variance.
double weight_of(const Correspondence& pair, double kernel_width) {
  const double normalised = pair.residual_m / std::sqrt(pair.variance_m2);
  return geman_mcclure_weight(normalised, kernel_width) * pair.confidence / pair.variance_m2;
}

/// cross_matrix(a) b = a × b.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& vector) {
  Eigen::Matrix3d matrix;
  matrix << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(), vector.x(), 0;
  return matrix;
}

void fill_upper(Matrix6d& lower) {
  lower.triangularView<Eigen::StrictlyUpper>() =
      lower.transpose().triangularView<Eigen::StrictlyUpper>();
}

/// Sums the information about a twist that is expected from random tilts of the normals alone. A
/// tilt is perpendicular to the normal. If A v is the Jacobian of a residual along a direction v,
/// A Aᵀ is the information of all three directions, from which the part along the normal is
/// subtracted. Thus only the moments of the points need to be summed, besides the Jacobians.
class TiltInformation {
 public:
  void add(const Correspondence& pair, double weight, const Vector6d& jacobian) {
    const double of_tilt = weight * pair.normal_sigma_rad * pair.normal_sigma_rad;
    weight_ += of_tilt;
    first_ += of_tilt * pair.point_m;
    second_ += of_tilt * pair.point_m * pair.point_m.transpose();
    along_normals_.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, of_tilt);
  }

  Matrix6d sum() const {
    Matrix6d all;
    all.topLeftCorner<3, 3>() = second_.trace() * Eigen::Matrix3d::Identity() - second_;
    all.topRightCorner<3, 3>() = cross_matrix(first_);
    all.bottomLeftCorner<3, 3>() = all.topRightCorner<3, 3>().transpose();
    all.bottomRightCorner<3, 3>() = weight_ * Eigen::Matrix3d::Identity();
    Matrix6d own = along_normals_;
    fill_upper(own);
    return all - own;
  }

 private:
  double weight_ = 0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
  Matrix6d along_normals_ = Matrix6d::Zero();  ///< lower triangle only
};

}  // namespace

NormalEquations build_equations(std::span<const Correspondence> pairs, double kernel_width) {
  NormalEquations equations;
  TiltInformation tilts;
  for (const Correspondence& pair : pairs) {
    const double weight = weight_of(pair, kernel_width);
    const Vector6d jacobian = residual_jacobian(pair);
    equations.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    equations.gradient += weight * pair.residual_m * jacobian;
    equations.weight_sum += weight;
    tilts.add(pair, weight, jacobian);
  }
  fill_upper(equations.information);
  equations.noise_induced = tilts.sum();
  return equations;
}

ResidualStatistics residual_statistics(const std::vector<Correspondence>& pairs,
                                       double kernel_scale, double kernel_width) {
  ResidualStatistics statistics;
  statistics.scale = kernel_scale;
  int inliers = 0;
  double sum = 0;
  for (const Correspondence& pair : pairs) {
    const double normalised = pair.residual_m / std::sqrt(pair.variance_m2);
    if (geman_mcclure_weight(normalised, kernel_width) < 0.5) continue;
    ++inliers;
    sum += pair.residual_m * pair.residual_m;
  }
  if (inliers == 0) return statistics;
  statistics.inlier_ratio = static_cast<double>(inliers) / static_cast<double>(pairs.size());
  statistics.rmse_m = std::sqrt(sum / inliers);
  return statistics;
}

void add_prior(NormalEquations& equations, const Vector6d& expected, const Vector6d& sigmas) {
  const Vector6d information = sigmas.cwiseAbs2().cwiseInverse();
  equations.information.diagonal() += information;
  equations.gradient -= information.cwiseProduct(expected);
}

Observability observability(const NormalEquations& equations, double lever_m) {
  Observability seen;
  seen.scale << Eigen::Vector3d::Constant(1 / lever_m), Eigen::Vector3d::Ones();
  if (!(equations.weight_sum > 0)) return seen;
  const Matrix6d scaled = seen.scale.asDiagonal() * equations.information *
                          seen.scale.asDiagonal() / equations.weight_sum;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
  seen.shares = solver.eigenvalues().cwiseMax(0);
  seen.directions = solver.eigenvectors();
  return seen;
}

std::vector<int> degenerate_directions(const Observability& seen, const NormalEquations& equations,
                                       const Vector6d& prior_sigmas) {
  std::vector<int> degenerate;
  for (int i = 0; i < seen.directions.cols(); ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double of_prior = twist.cwiseQuotient(prior_sigmas).squaredNorm();
    const double of_surfaces =
        twist.dot((equations.information - 2 * equations.noise_induced) * twist);
    if (of_surfaces < of_prior) degenerate.push_back(i);
  }
  return degenerate;
}

Matrix6d surface_information(const Observability& seen, const NormalEquations& equations) {
  Matrix6d information = Matrix6d::Zero();
  for (int i = 0; i < seen.directions.cols(); ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double all = twist.dot(equations.information * twist);
    const double of_surfaces = all - 2 * twist.dot(equations.noise_induced * twist);
    if (of_surfaces <= 0) continue;
    const Vector6d direction = seen.directions.col(i).cwiseQuotient(seen.scale);
    information += of_surfaces * of_surfaces / all * direction * direction.transpose();
  }
  return information;
}

void remove_information(NormalEquations& equations, const Observability& seen,
                        std::span<const int> directions) {
  Matrix6d kept = Matrix6d::Identity();
  for (const int i : directions) {
    kept -= seen.directions.col(i) * seen.directions.col(i).transpose();
  }
  // The directions are orthogonal only in scaled coordinates.
  const Matrix6d keep = seen.scale.asDiagonal() * kept * seen.scale.cwiseInverse().asDiagonal();
  equations.information = keep.transpose() * equations.information * keep;
  equations.gradient = keep.transpose() * equations.gradient;
}

}  // namespace tofmap
