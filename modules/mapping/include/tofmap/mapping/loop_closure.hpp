// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

struct LoopOptions {
  bool close = true;
  double radius_m = 3;
  double max_rotation_rad = 1;
  int min_gap = 20;
  double min_overlap = 0.35;
  double min_inlier_ratio = 0.7;
  double drift_share = 0.01;
  double kernel_width = 3;

  static std::vector<OptionField<LoopOptions>> fields();
};

/// Drift of directions: a metre's drift in position comes with this.
inline constexpr double drift_rad_per_drift_m = 0.3;

/// Where a camera is expected, and how far it may have drifted along a path, metres.
MotionPrior drift_prior(const Pose& expected, double path_m, const LoopOptions& options);

/// What became of the search for a loop.
struct LoopCandidate {
  int from = -1;  ///< id of the earlier keyframe; −1: there is none
  RegistrationResult registration;
  std::optional<PoseEdge> edge;  ///< if the loop was verified
};

/// Looks for an earlier keyframe that sees what `keyframe` sees.
///
/// Candidates are keyframes at least `min_gap` before it, whose cameras stand within `radius_m` and
/// look within `max_rotation_rad` of the same direction. The three that overlap most are registered
/// against together, from the pose as it is believed and with a prior as wide as drift allows:
/// `drift_share` of the path between. If that is not verified, drift may have been larger: then the
/// candidate that looks most like the keyframe is registered against from where it stands, and what
/// is found counts if it is within three standard deviations of drift. The loop is there if
/// is_verified(). Only keyframes before it in `keyframes`, which are in order of their ids, are
/// looked at.
LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration);

/// Registers twice: first across gaps of twice the prior's standard deviation, up to a metre; then,
/// from what that finds, as closely as frames are registered.
RegistrationResult register_from_afar(const SurfaceCloud& cloud,
                                      std::span<const RegistrationTarget> targets,
                                      const CameraModel& camera, const MotionPrior& prior,
                                      const RegistrationOptions& registration);

/// How far from a keyframe a camera may stand and look that is recognised by it.
inline constexpr double recognition_reach_m = 0.5;
inline constexpr double recognition_reach_rad = 0.35;

/// Registers a cloud from afar as if it had been taken where a keyframe was, against that one and
/// those before and after it in `keyframes`.
RegistrationResult register_near(const Keyframe& keyframe, const SurfaceCloud& cloud,
                                 std::span<const Keyframe> keyframes, const CameraModel& camera,
                                 const RegistrationOptions& registration);

/// Whether a registration far from where the path came from can be believed: it converged with
/// `min_overlap` and `min_inlier_ratio`, and leaves no direction to the prior.
bool is_verified(const RegistrationResult& result, const LoopOptions& options);

/// The edge that a registration against `from` measures, with what registration cannot know of its
/// own errors added to its covariance.
PoseEdge edge_of(const Keyframe& from, int to, const Pose& world_from_camera,
                 const Eigen::Matrix<double, 6, 6>& covariance);

}  // namespace tofmap
