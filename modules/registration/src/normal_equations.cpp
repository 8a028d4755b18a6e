// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

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
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::ranges::nth_element(deviations, middle);
  constexpr double sigma_of_median_deviation = 1.4826;  // of a normal distribution
  return std::max(1.0, sigma_of_median_deviation * *middle);
}

double geman_mcclure_weight(double normalised_residual, double width) {
  const double ratio = 1 / (1 + (normalised_residual / width) * (normalised_residual / width));
  return ratio * ratio;
}

NormalEquations build_equations(const std::vector<Correspondence>& pairs, double kernel_width) {
  NormalEquations equations;
  for (const Correspondence& pair : pairs) {
    const double normalised = pair.residual_m / std::sqrt(pair.variance_m2);
    const double weight = geman_mcclure_weight(normalised, kernel_width) / pair.variance_m2;
    const Vector6d jacobian = residual_jacobian(pair);
    equations.information.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
    equations.gradient += weight * pair.residual_m * jacobian;
    equations.weight_sum += weight;
  }
  equations.information.triangularView<Eigen::StrictlyUpper>() =
      equations.information.transpose().triangularView<Eigen::StrictlyUpper>();
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

int drop_open_directions(NormalEquations& equations, const Observability& seen, double min_share) {
  int open = 0;
  while (open < 6 && seen.shares[open] < min_share) ++open;
  if (open == 0) return 0;
  // In scaled coordinates the directions are orthonormal: project the system onto the rest.
  const Vector6d unscale = seen.scale.cwiseInverse();
  const Eigen::Matrix<double, 6, Eigen::Dynamic> kept = seen.directions.rightCols(6 - open);
  const Matrix6d projector = kept * kept.transpose();
  const Matrix6d scaled =
      projector * (seen.scale.asDiagonal() * equations.information * seen.scale.asDiagonal()) *
      projector;
  equations.information = unscale.asDiagonal() * scaled * unscale.asDiagonal();
  equations.gradient =
      unscale.asDiagonal() * projector * seen.scale.cwiseProduct(equations.gradient);
  return open;
}

}  // namespace tofmap
