// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// How far a trajectory is from the true one (metrics of the TUM RGB-D benchmark, Sturm et
/// al., IROS 2012).
struct TrajectoryScore {
  int matched = 0;      ///< poses with a true pose within 20 ms
  double length_m = 0;  ///< of the true path over the matched poses
  double ate_rmse_m = 0;
  double ate_max_m = 0;
  /// Relative error over each metre of the true path; NaN if the path is shorter.
  double rpe_rmse_m_per_m = 0;
  double rpe_rmse_deg_per_m = 0;
  Pose truth_from_estimate = Pose::Identity();  ///< the alignment (Horn), no scale
};

/// Scores an estimate; nothing if fewer than three poses can be matched.
std::optional<TrajectoryScore> score_trajectory(const Trajectory& estimate,
                                                const Trajectory& truth);

/// How far one pose of an aligned trajectory is from the true one.
struct PoseError {
  double timestamp_s = 0;
  double error_m = 0;
};

/// The errors of all poses that have a true pose within 20 ms, after the alignment of a score.
std::vector<PoseError> pose_errors(const Trajectory& estimate, const Trajectory& truth,
                                   const Pose& truth_from_estimate);

}  // namespace tofmap
