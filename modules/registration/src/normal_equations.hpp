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
  /// The part of `information` that is noise-induced: it comes from the noise of normals alone.
  Matrix6d noise_induced = Matrix6d::Zero();

  NormalEquations& operator+=(const NormalEquations& other);
};

/// How well the residuals fit at one pose.
struct ResidualStatistics {
  double scale = 0;  ///< robust standard deviation of residual / predicted sigma
  double inlier_ratio = 0;
  double rmse_m = 0;  ///< over the inliers
};

/// Derivative of the distance of a point from a plane through it with respect to the twist.
Vector6d residual_jacobian(const Eigen::Vector3d& point_m, const Eigen::Vector3d& normal);

/// Robust standard deviation of residual / predicted sigma: 1.4826 times the median magnitude, and
/// at least 1, since a fit that is better than the predicted noise is due to chance.
double robust_scale(const std::vector<Correspondence>& pairs);

/// Weight of a normalised residual under the kernel of Geman and McClure of this width:
/// 1 / (1 + (residual / width)²)².
double geman_mcclure_weight(double normalised_residual, double width);

/// The system of all correspondences. `kernel_width` is a normalised residual.
///
/// The Jacobian of a residual is the mean of those with the target's normal and with the source's.
/// Noise of the normals adds its square to the information. It is independent in source and target,
/// and thus absent, on average, from the product of one Jacobian with the other (instrumental
/// variables: Fuller 1987, "Measurement error models", section 1.4). What the information has
/// beyond these products is noise-induced. It needs no model of the normals' errors, which also
/// come from edges and curved surfaces. An error that both normals share remains unnoticed.
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

/// The share of the information along each of the directions of `seen` that is not noise-induced, 0
/// … 1.
Vector6d surface_shares(const Observability& seen, const NormalEquations& equations);

/// Keeps a share of each of the directions of `seen`, so that a solution of the system has neither
/// the bias nor the overconfidence that come from noise-induced information.
///
/// Noise-induced information N does not restore the pose, but adds to the noise of the gradient.
/// Along a direction, the solution of a system with the information H therefore is
/// −gradient / (H − N), and its variance H / (H − N)². The information becomes the inverse of that
/// variance, with 1.25 N in place of N as a margin, and the gradient such that this is the
/// solution. A direction with the share 0 is removed from the system.
void keep_shares(NormalEquations& equations, const Observability& seen, const Vector6d& shares);

/// The degenerate directions, as columns of `seen.directions`: those about which the surfaces give
/// less information than a prior with these standard deviations. `information` is what
/// keep_shares() leaves.
///
/// As in Zhang, Kaess and Singh (ICRA 2016, "On degeneracy of optimization-based state estimation
/// problems"), eigenvectors of the information are tested one by one, and the degenerate ones are
/// left out of the solution. There the limit is an eigenvalue to be chosen; here it is the prior.
std::vector<int> degenerate_directions(const Observability& seen, const Matrix6d& information,
                                       const Vector6d& prior_sigmas);

}  // namespace tofmap
