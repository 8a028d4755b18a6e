// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/pose_spread.hpp>
#include <tofmap/registration/pose_graph.hpp>
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

/// Result of a search for a loop.
struct LoopCandidate {
  int from = -1;                    ///< id of the earlier keyframe; −1 if there is no candidate
  RegistrationResult registration;  ///< of the later keyframe with the earlier one
  std::optional<PoseEdge> edge;     ///< loop constraint; empty if the loop was not verified
};

/// Searches for an earlier keyframe that sees the same place as `keyframe`.
///
/// `spreads` holds, for each keyframe, the uncertainty of its pose relative to `keyframe` that
/// follows from registrations. The drift consists of this and of the drift along the path.
/// Candidates are keyframes of the same map with an id that is smaller by at least `min_keyframes`,
/// or with a spread that no frame can be registered across (KeyframeGraph::well_connected_sigma_m).
/// Their cameras are within `radius_m` and `max_rotation_rad` of the camera of `keyframe`, plus
/// three standard deviations of drift.
///
/// First, `keyframe` is registered with the three candidates that overlap it most, together, from
/// its current pose with a prior of drift. If that is wider than ICP reaches, or if the result is
/// not verified, the place is recognised among the candidates (recognise()), and the result is
/// accepted if it is within two standard deviations of drift. A loop is found if the candidate
/// confirms the result (confirms_place()), and if the surfaces of the candidate alone determine the
/// relative pose (to KeyframeGraph::well_connected_sigma_m). `keyframes` are in the order of their
/// ids, from 0, and hold all earlier keyframes; later ones are ignored.
LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        std::span<const std::optional<PoseSpread>> spreads,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration);

/// Registers a cloud whose pose is known only roughly, in two stages: first with correspondence
/// distances up to twice the prior's standard deviation, at most 1 m, then from the resulting pose
/// with the given options.
RegistrationResult register_from_afar(const SurfaceCloud& cloud,
                                      std::span<const RegistrationTarget> targets,
                                      const CameraModel& camera, const MotionPrior& prior,
                                      const RegistrationOptions& registration);

/// How far a camera may be from a keyframe that recognises it: the standard deviations of the prior
/// of register_near().
inline constexpr double recognition_reach_m = 0.5;
inline constexpr double recognition_reach_rad = 0.35;

/// Registers a cloud with a keyframe and the keyframes directly before and after it, from the pose
/// of that keyframe (register_from_afar()).
RegistrationResult register_near(const Keyframe& keyframe, const SurfaceCloud& cloud,
                                 std::span<const Keyframe> keyframes, const CameraModel& camera,
                                 const RegistrationOptions& registration);

/// Share of a cloud's points that fit the surfaces: the product of overlap and inlier ratio. 0 if
/// registration failed.
double support(const RegistrationResult& result);

/// Whether a registration that does not follow from the motion of the camera can be trusted: it
/// converged, reaches `min_overlap` and `min_inlier_ratio`, and has no degenerate direction.
bool is_verified(const RegistrationResult& result, const LoopOptions& options);

/// Whether a registration of a cloud near a keyframe is verified (is_verified()) and does not
/// contradict the free space of the keyframe (contradicts_free_space()).
bool confirms_place(const Keyframe& keyframe, const SurfaceCloud& cloud,
                    const RegistrationResult& result, const CameraModel& camera,
                    const LoopOptions& options);

/// The covariance of a pose relative to a keyframe, given the information that a registration has
/// from the surfaces of that keyframe. Along directions without information, the standard
/// deviations are 1 m and 0.5 rad, since registration would not have found the keyframe from
/// farther away.
Eigen::Matrix<double, 6, 6> covariance_of(const Eigen::Matrix<double, 6, 6>& information);

/// The edge of the pose graph from a registration of keyframe `to` with keyframe `from`.
/// `covariance` is that of the pose error, along the world's axes. That of the edge is along the
/// axes of `from`, and increased by the errors that neighbouring frames share, which registration
/// cannot measure.
PoseEdge edge_of(const Keyframe& from, int to, const Pose& world_from_camera,
                 const Eigen::Matrix<double, 6, 6>& covariance);

/// The loop constraint from a registration of keyframe `to` near keyframe `from`, which was the
/// first target. Its covariance comes from what the surfaces of `from` alone constrain.
PoseEdge loop_edge(const Keyframe& from, int to, const RegistrationResult& result);

}  // namespace tofmap
