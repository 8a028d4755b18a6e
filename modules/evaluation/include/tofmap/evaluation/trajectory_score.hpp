// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// The errors of a trajectory against the true one: ATE and RPE of the TUM RGB-D benchmark (Sturm
/// et al., IROS 2012).
struct TrajectoryScore {
  int matched = 0;        ///< number of poses with a true pose within 20 ms
  double length_m = 0;    ///< length of the true path through the matched poses
  double ate_rmse_m = 0;  ///< RMS distance of aligned positions from the true ones
  double ate_max_m = 0;   ///< largest of these distances
  /// RMS error of the relative translation over each metre of the true path. NaN if the path is
  /// shorter.
  double rpe_rmse_m_per_m = 0;
  /// RMS error of the relative rotation over each metre of the true path. NaN if the path is
  /// shorter.
  double rpe_rmse_deg_per_m = 0;
  /// The rigid transform, without scale, that best aligns the positions (Umeyama 1991). If these
  /// are within 10 cm of a line, about which they do not determine the rotation, it aligns points
  /// 1 m from the positions along the camera's axes as well.
  Pose truth_from_estimate = Pose::Identity();
};

/// Scores an estimated trajectory. Empty if fewer than three of its poses have a true pose within
/// 20 ms.
std::optional<TrajectoryScore> score_trajectory(const Trajectory& estimate,
                                                const Trajectory& truth);

/// The position error of one pose of an aligned trajectory.
struct PoseError {
  double timestamp_s = 0;
  double error_m = 0;  ///< distance from the true position
};

/// The position errors of all poses with a true pose within 20 ms, after alignment by
/// `truth_from_estimate` (see TrajectoryScore).
std::vector<PoseError> pose_errors(const Trajectory& estimate, const Trajectory& truth,
                                   const Pose& truth_from_estimate);

}  // namespace tofmap
