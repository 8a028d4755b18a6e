// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A measured relative pose between two poses of a graph.
struct PoseEdge {
  int from = 0;                          ///< index of a pose
  int to = 0;                            ///< index of another pose
  Pose from_from_to = Pose::Identity();  ///< the pose of `to` in the frame of `from`
  /// Covariance of the measurement error: rotation vector, radians, then translation, metres, both
  /// along the axes of `from`. Must be positive definite.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  /// True for a loop constraint, which may connect different places. Such edges go through a robust
  /// kernel, so that a wrong one does not distort the graph.
  bool may_be_wrong = false;
};

/// Adds an independent error with these standard deviations, the same along all axes, to the
/// covariance of an edge.
void widen(PoseEdge& edge, double rotation_sigma_rad, double translation_sigma_m);

/// A covariance or information of a twist, along other axes. `new_from_old` rotates vectors along
/// the axes of `matrix` into the new ones.
Eigen::Matrix<double, 6, 6> rotated(const Eigen::Matrix<double, 6, 6>& matrix,
                                    const Eigen::Matrix3d& new_from_old);

/// A twist along other axes.
Eigen::Matrix<double, 6, 1> rotated_twist(const Eigen::Matrix<double, 6, 1>& twist,
                                          const Eigen::Matrix3d& new_from_old);

/// Maps a small twist of a body to that of its point at `offset_m`: a rotation swings the point
/// around. All are along the same axes.
Eigen::Matrix<double, 6, 6> twist_at_offset(const Eigen::Vector3d& offset_m);

/// Throws UsageError if an edge refers to a pose that does not exist, or connects a pose with
/// itself. `poses` is their number.
void check_edges(std::span<const PoseEdge> edges, std::size_t poses);

/// Optimised poses and how well the edges fit them.
struct PoseGraphResult {
  std::vector<Pose> poses;  ///< in the order of the initial poses
  bool converged = false;   ///< whether the solver converged in its last pass
  int iterations = 0;       ///< of all passes together
  /// Mahalanobis distance √(eᵀ Σ⁻¹ e) of each edge at the optimised poses.
  std::vector<double> edge_mahalanobis;
};

/// Finds the poses that fit all edges best, by nonlinear least squares over rotations and
/// translations (Ceres, Levenberg-Marquardt). The first `held` poses are held fixed; of others that
/// edges connect, the first one is, unless they are connected with a fixed one.
///
/// Edges that may be wrong go through a Geman-McClure kernel whose width is halved from pass to
/// pass until it is `kernel_width` standard deviations (graduated non-convexity, Yang et al., RA-L
/// 5(2), 2020). Thus correct loops are not rejected because of the drift that they correct, and
/// wrong ones are down-weighted. The result does not depend on the number of threads.
///
/// Throws UsageError as check_edges() does.
PoseGraphResult optimise_pose_graph(std::vector<Pose> poses, std::span<const PoseEdge> edges,
                                    double kernel_width, std::size_t held = 0);

/// The Mahalanobis distance √(eᵀ Σ⁻¹ e) of an edge, where e is the error of the measured relative
/// pose at these poses.
double mahalanobis_distance(const PoseEdge& edge, const std::vector<Pose>& poses);

/// Whether the kernel rejects an edge at this Mahalanobis distance: its weight is less than a
/// sixteenth of the weight of an edge without error.
bool is_rejected(double mahalanobis_distance, double kernel_width);

}  // namespace tofmap
