// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "correspondences.hpp"

#include <span>
#include <vector>

namespace tofmap {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Gauss-Newton system of weighted residuals in the twist (rotation vector about the local origin,
/// then translation): information · twist = −gradient.
struct NormalEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double weight_sum = 0;  ///< of confidence / variance, kernel included
  /// The expected part of `information` that is noise-induced: it comes from the noise of normals
  /// alone.
  Matrix6d noise_induced = Matrix6d::Zero();
};

/// How well the residuals fit at one pose.
struct ResidualStatistics {
  double scale = 0;  ///< robust standard deviation of residual / predicted sigma
  double inlier_ratio = 0;
  double rmse_m = 0;  ///< over the inliers
};

/// Derivative of the residual of a correspondence with respect to the twist.
Vector6d residual_jacobian(const Correspondence& pair);

/// Robust standard deviation of residual / predicted sigma: 1.4826 times the median magnitude, and
/// at least 1, since a fit that is better than the predicted noise is due to chance.
double robust_scale(const std::vector<Correspondence>& pairs);

/// Weight of a normalised residual under the kernel of Geman and McClure of this width:
/// 1 / (1 + (residual / width)²)².
double geman_mcclure_weight(double normalised_residual, double width);

/// The system of all correspondences. `kernel_width` is a normalised residual.
NormalEquations build_equations(std::span<const Correspondence> pairs, double kernel_width);

/// An inlier is a correspondence whose kernel weight is at least one half. `kernel_scale` is copied
/// to the result.
ResidualStatistics residual_statistics(const std::vector<Correspondence>& pairs,
                                       double kernel_scale, double kernel_width);

/// Adds a prior with mean `expected` and standard deviations `sigmas` for the twist.
void add_prior(NormalEquations& equations, const Vector6d& expected, const Vector6d& sigmas);

/// How strongly the observations constrain each direction of motion. Rotations are scaled to the
/// motion of points at a typical distance, so that all six directions are comparable.
struct Observability {
  Vector6d shares = Vector6d::Zero();          ///< eigenvalues / weight_sum, in ascending order
  Matrix6d directions = Matrix6d::Identity();  ///< columns: eigenvectors, in the same order
  Vector6d scale = Vector6d::Ones();           ///< twist = scale ∘ direction
};

/// Eigen-decomposition of the information, scaled by a typical distance `lever_m` of the points.
Observability observability(const NormalEquations& equations, double lever_m);

/// The degenerate directions, as columns of `seen.directions`: those about which the surfaces give
/// less information than a prior with these standard deviations. Twice the noise-induced
/// information is subtracted first, as a margin, since the noise of normals is known only roughly.
///
/// As in Zhang, Kaess and Singh (ICRA 2016, "On degeneracy of optimization-based state estimation
/// problems"), eigenvectors of the information are tested one by one, and the degenerate ones are
/// left out of the solution. There the limit is an eigenvalue to be chosen; here it is the prior.
std::vector<int> degenerate_directions(const Observability& seen, const NormalEquations& equations,
                                       const Vector6d& prior_sigmas);

/// The information that the surfaces give about the pose that solves the equations: the inverse
/// covariance of the solution, without the noise of normals.
///
/// Noise-induced information N does not restore the pose, but adds to the noise of the gradient.
/// Along each of the directions of `seen`, the solution of a system with the information H
/// therefore has the variance H / (H − N)², where 1 / H would claim too little. As in
/// degenerate_directions(), N is taken twice.
Matrix6d surface_information(const Observability& seen, const NormalEquations& equations);

/// Removes all information about these directions from the equations.
void remove_information(NormalEquations& equations, const Observability& seen,
                        std::span<const int> directions);

}  // namespace tofmap
