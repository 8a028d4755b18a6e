// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/option_table.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Options of loop closure and relocalisation.
struct LoopOptions {
  /// Whether loops are searched for, and the path corrected by them.
  bool close = true;
  /// Loops are searched for among keyframes that are at most this far away by their current poses,
  /// plus the uncertainty of these poses; 0.1 … 100 m.
  double radius_m = 3;
  /// Loops are searched for among keyframes that are rotated by at most this by their current
  /// poses, 0.01 … 3.2 rad.
  double max_rotation_rad = 1;
  /// Smallest difference between the ids of the keyframes of a loop, 1 … 100000.
  int min_keyframes = 20;
  /// Smallest share of a keyframe's points that must have a correspondence in earlier keyframes,
  /// 0.01 … 1.
  double min_overlap = 0.35;
  /// Smallest share of the correspondences of a loop that must fit its pose, 0 … 1.
  double min_inlier_ratio = 0.7;
  /// Standard deviation of the drift in position as a share of the length of the path between both
  /// keyframes of a loop, 0 … 1.
  double drift_share = 0.01;
  /// Width of the kernel of the pose graph in standard deviations of a loop constraint, 0.5 … 100.
  /// Loop constraints with larger errors are down-weighted.
  double kernel_width = 3;

  static std::vector<OptionField<LoopOptions>> fields();
};

/// Drift in rotation that comes with a drift of one metre in position.
inline constexpr double drift_rad_per_drift_m = 0.3;

/// A prior at the expected pose whose standard deviations are those of the drift along a path of
/// this length, and at least 0.05 m and 0.03 rad.
MotionPrior drift_prior(const Pose& expected, double path_m, const LoopOptions& options);

}  // namespace tofmap
