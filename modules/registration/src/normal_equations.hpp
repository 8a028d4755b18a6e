// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "correspondences.hpp"

#include <span>
#include <vector>

namespace tofmap {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Gauss-Newton system of the weighted point-to-plane residuals in the twist (rotation about
/// the local origin, translation): information · twist = −gradient.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double weight_sum = 0;  ///< of confidence / variance, kernel included
  /// What of that information is expected to come from the noise of the normals alone.
  Matrix6d noise_induced = Matrix6d::Zero();
};

/// How well the residuals fit at one pose.
struct ResidualStatistics {
  double scale = 0;  ///< robust standard deviation of residual / predicted sigma
  double inlier_ratio = 0;
  double rmse_m = 0;  ///< over the inliers
};

/// Derivative of a residual by the twist.
Vector6d residual_jacobian(const Correspondence& pair);

/// 1.4826 times the median of |residual| / sigma: robust, and never below 1, since a fit
/// better than the predicted noise is chance.
double robust_scale(const std::vector<Correspondence>& pairs);

/// Weight of a normalised residual under Geman-McClure of this width.
double geman_mcclure_weight(double normalised_residual, double width);

NormalEquations build_equations(const std::vector<Correspondence>& pairs, double kernel_width);

ResidualStatistics residual_statistics(const std::vector<Correspondence>& pairs,
                                       double kernel_scale, double kernel_width);

/// Adds a prior that holds the twist at `expected`.
void add_prior(NormalEquations& equations, const Vector6d& expected, const Vector6d& sigmas);

/// Which directions the observations constrain. Rotations are measured as the motion of points
/// at `lever_m`, so that all six compare.
struct Observability {
  Vector6d shares = Vector6d::Zero();          ///< ascending
  Matrix6d directions = Matrix6d::Identity();  ///< columns: scaled twists, same order
  Vector6d scale = Vector6d::Ones();           ///< twist = scale ∘ direction
};

Observability observability(const NormalEquations& equations, double lever_m);

/// The directions that are open, by their columns: the surfaces say less of them than a prior of
/// these standard deviations. What noisy normals feign is taken off twice, since how noisy they
/// are is known by no more than that.
std::vector<int> open_directions(const Observability& seen, const NormalEquations& equations,
                                 const Vector6d& prior_sigmas);

/// Takes from the equations what they say of these directions.
void leave_open(NormalEquations& equations, const Observability& seen,
                std::span<const int> directions);

}  // namespace tofmap
