// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "normal_equations.hpp"

#include "tofmap/registration/robust_kernel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <tofmap/core/median.hpp>

namespace tofmap {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  information += other.information;
  gradient += other.gradient;
  weight_sum += other.weight_sum;
  noise_induced += other.noise_induced;
  return *this;
}

Vector6d residual_jacobian(const Eigen::Vector3d& point_m, const Eigen::Vector3d& normal) {
  Vector6d jacobian;
  jacobian << point_m.cross(normal), normal;
  return jacobian;
}

double robust_scale(const std::vector<Correspondence>& pairs) {
  if (pairs.empty()) return 1;
  std::vector<double> squares(pairs.size());
  std::ranges::transform(pairs, squares.begin(), [](const Correspondence& pair) {
    return pair.residual_m * pair.residual_m / pair.variance_m2;
  });
  return std::max(1.0, sigma_of_median_deviation * std::sqrt(median(squares)));
}

namespace {

double kernel_weight(const Correspondence& pair, double kernel_width) {
  return geman_mcclure_weight_of_squares(pair.residual_m * pair.residual_m,
                                         kernel_width * kernel_width * pair.variance_m2);
}

/// The part of a share of the information that is relied on. The noise-induced rest is estimated
/// from few normals where a direction is weak, so a quarter more of it is left out.
double relied_on(double share) {
  constexpr double margin = 1.25;
  return std::max(0.0, 1 - margin * (1 - share));
}

}  // namespace

double geman_mcclure_weight(double normalised_residual, double width) {
  return geman_mcclure_weight_of_squares(normalised_residual * normalised_residual, width * width);
}

NormalEquations build_equations(std::span<const Correspondence> pairs, double kernel_width) {
  NormalEquations equations;
  for (const Correspondence& pair : pairs) {
    const double weight = kernel_weight(pair, kernel_width) * pair.confidence / pair.variance_m2;
    const Vector6d of_target = residual_jacobian(pair.point_m, pair.normal);
    const Vector6d of_source = residual_jacobian(pair.point_m, pair.source_normal);
    const Vector6d mean = (of_target + of_source) / 2;
    const Vector6d half_difference = (of_target - of_source) / 2;
    const Vector6d weighted = weight * mean;
    equations.information.noalias() += weighted * mean.transpose();
    equations.noise_induced.noalias() += (weight * half_difference) * half_difference.transpose();
    equations.gradient += pair.residual_m * weighted;
    equations.weight_sum += weight;
  }
  return equations;
}

ResidualStatistics residual_statistics(const std::vector<Correspondence>& pairs,
                                       double kernel_scale, double kernel_width) {
  ResidualStatistics statistics;
  statistics.scale = kernel_scale;
  int inliers = 0;
  double sum = 0;
  for (const Correspondence& pair : pairs) {
    if (kernel_weight(pair, kernel_width) < 0.5) continue;
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

Vector6d surface_shares(const Observability& seen, const NormalEquations& equations) {
  Vector6d shares = Vector6d::Zero();
  for (int i = 0; i < seen.directions.cols(); ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double all = twist.dot(equations.information * twist);
    if (!(all > 0)) continue;
    shares[i] = std::clamp(1 - twist.dot(equations.noise_induced * twist) / all, 0.0, 1.0);
  }
  return shares;
}

void keep_shares(NormalEquations& equations, const Observability& seen, const Vector6d& shares) {
  const Vector6d of_information = shares.unaryExpr(&relied_on);
  const Vector6d of_gradient = shares.unaryExpr([](double share) {
    const double relied = relied_on(share);
    return relied > 0 ? relied * relied / share : 0.0;
  });
  // The directions are orthogonal only in scaled coordinates.
  const auto along_directions = [&](const Vector6d& factors) -> Matrix6d {
    const Matrix6d scaled = seen.directions * factors.asDiagonal() * seen.directions.transpose();
    return seen.scale.asDiagonal() * scaled * seen.scale.cwiseInverse().asDiagonal();
  };
  const Matrix6d keep = along_directions(of_information);
  equations.information = keep.transpose() * equations.information * keep;
  equations.gradient = along_directions(of_gradient).transpose() * equations.gradient;
}

std::vector<int> degenerate_directions(const Observability& seen, const Matrix6d& information,
                                       const Vector6d& prior_sigmas) {
  std::vector<int> degenerate;
  for (int i = 0; i < seen.directions.cols(); ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double of_prior = twist.cwiseQuotient(prior_sigmas).squaredNorm();
    if (twist.dot(information * twist) < of_prior) degenerate.push_back(i);
  }
  return degenerate;
}

}  // namespace tofmap
