// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A measured motion between two poses of a graph.
struct PoseEdge {
  int from = 0;
  int to = 0;
  Pose from_from_to = Pose::Identity();  ///< the pose of `to` in the frame of `from`
  /// Of the measurement's error: rotation vector, radians, and translation, metres, both along the
  /// axes of `from`. Must be positive definite.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  bool may_be_wrong = false;  ///< a loop: few large errors must not bend the graph
};

/// Adds errors of these standard deviations, the same along all axes, to those of an edge.
void widen(PoseEdge& edge, double rotation_sigma_rad, double translation_sigma_m);

struct PoseGraphResult {
  std::vector<Pose> poses;
  bool converged = false;
  int iterations = 0;
  /// Of each edge: its error in standard deviations, √(eᵀ Σ⁻¹ e), at the end.
  std::vector<double> edge_mahalanobis;
};

/// The poses that fit all edges best, the first one held: nonlinear least squares over rotations
/// and translations (Ceres, Levenberg-Marquardt).
///
/// Edges that may be wrong go through a Geman-McClure kernel whose width shrinks to
/// `kernel_width` standard deviations from pass to pass (graduated non-convexity, Yang et al.,
/// RA-L 5(2), 2020): so right loops are not shut out by the drift that they are to mend, and wrong
/// ones lose their say. The result does not depend on the number of threads.
///
/// Throws UsageError if an edge names a pose that is not there, or the same one twice.
PoseGraphResult optimise_pose_graph(std::vector<Pose> poses, std::span<const PoseEdge> edges,
                                    double kernel_width);

/// The error of an edge between these poses in standard deviations, √(eᵀ Σ⁻¹ e).
double mahalanobis_distance(const PoseEdge& edge, const std::vector<Pose>& poses);

/// Whether an edge that may be wrong has hardly a say left with these deviations: a sixteenth of
/// that of an edge without error, or less.
bool is_outvoted(double deviations, double kernel_width);

}  // namespace tofmap
