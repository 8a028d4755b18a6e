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

/// Geman-McClure times the inverse of the predicted variance.
double weight_of(const Correspondence& pair, double kernel_width) {
  const double normalised = pair.residual_m / std::sqrt(pair.variance_m2);
  return geman_mcclure_weight(normalised, kernel_width) / pair.variance_m2;
}

void fill_upper(Matrix6d& lower) {
  lower.triangularView<Eigen::StrictlyUpper>() =
      lower.transpose().triangularView<Eigen::StrictlyUpper>();
}

}  // namespace

NormalEquations build_equations(const std::vector<Correspondence>& pairs, double kernel_width) {
  NormalEquations equations;
  for (const Correspondence& pair : pairs) {
    const double weight = weight_of(pair, kernel_width);
    const Vector6d jacobian = residual_jacobian(pair);
    equations.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    equations.gradient += weight * pair.residual_m * jacobian;
    equations.weight_sum += weight;
  }
  fill_upper(equations.information);
  return equations;
}

Matrix6d feigned_information(const std::vector<Correspondence>& pairs, double kernel_width) {
  Matrix6d feigned = Matrix6d::Zero();
  for (const Correspondence& pair : pairs) {
    const double weight =
        weight_of(pair, kernel_width) * pair.normal_sigma_rad * pair.normal_sigma_rad;
    const Eigen::Vector3d along = pair.normal.unitOrthogonal();
    const Eigen::Vector3d across = pair.normal.cross(along);
    for (const Eigen::Vector3d& tilt : {along, across}) {
      Vector6d jacobian;
      jacobian << pair.point_m.cross(tilt), tilt;
      feigned.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    }
  }
  fill_upper(feigned);
  return feigned;
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
  statistics.inlier_share = static_cast<double>(inliers) / static_cast<double>(pairs.size());
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

std::vector<int> open_directions(const Observability& seen, const NormalEquations& equations,
                                 const Matrix6d& feigned, const Vector6d& prior_sigmas) {
  std::vector<int> open;
  for (int i = 0; i < seen.directions.cols(); ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double of_prior = twist.cwiseQuotient(prior_sigmas).squaredNorm();
    const double of_surfaces = twist.dot((equations.information - 2 * feigned) * twist);
    if (of_surfaces < of_prior) open.push_back(i);
  }
  return open;
}

void leave_open(NormalEquations& equations, const Observability& seen,
                std::span<const int> directions) {
  Matrix6d kept = Matrix6d::Identity();
  for (const int i : directions) {
    kept -= seen.directions.col(i) * seen.directions.col(i).transpose();
  }
  // Directions are orthogonal where rotations count as the motion of points.
  const Matrix6d keep = seen.scale.asDiagonal() * kept * seen.scale.cwiseInverse().asDiagonal();
  equations.information = keep.transpose() * equations.information * keep;
  equations.gradient = keep.transpose() * equations.gradient;
}

}  // namespace tofmap
