// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/pose_spread.hpp>
#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Result of a search for a loop.
struct LoopCandidate {
  int from = -1;                    ///< id of the earlier keyframe; −1 if there is no candidate
  RegistrationResult registration;  ///< of the later keyframe with the earlier one
  std::optional<PoseEdge> edge;     ///< loop constraint; empty if the loop was not verified
  /// Whether drift does not explain the correction that the loop asks for. Then the loop is to be
  /// used only if a slip of odometry does (find_slip()).
  bool needs_slip = false;
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
/// not verified, the place is recognised (find_places()) among those keyframes with an id that is
/// smaller by at least `min_keyframes` that look alike, and the result is accepted if it is within
/// two standard deviations of drift; if there is none, also if it is at most `farthest_slip_m` and
/// `max_rotation_rad` away. A loop is found if the candidate confirms the result
/// (confirms_place()), and if the surfaces of the candidate alone determine the relative pose (to
/// KeyframeGraph::well_connected_sigma_m). `keyframes` are in the order of their ids, from 0, and
/// hold all earlier keyframes; later ones are ignored.
LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        std::span<const std::optional<PoseSpread>> spreads,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration);

}  // namespace tofmap
