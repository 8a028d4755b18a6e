// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A slip of odometry: a keyframe was registered beside its true place, and all later ones relative
/// to it.
struct Slip {
  int at = 0;                   ///< id of the first keyframe that is off
  std::vector<PoseEdge> edges;  ///< from keyframes before it, registered anew
};

/// Largest correction of a keyframe that is a slip: three times what the prior of odometry allows a
/// frame.
inline constexpr double farthest_slip_m = 0.75;

/// Searches for a slip that explains a loop which puts its later keyframe elsewhere.
///
/// After a slip, all keyframes are off by the same correction. Therefore each keyframe between both
/// ends of the loop is registered at its corrected pose with those that odometry registered it with
/// (`edges`). A slip is found if the result is at that pose, confirms the place as a loop does
/// (confirms_place()), and either fits clearly better (by 10 %) than a registration at the believed
/// pose, or that registration moves away from it. Of several slips, the one that fits best is
/// returned. Corrections of less than KeyframeGraph::well_connected_sigma_m, which are drift, and
/// of more than `farthest_slip_m` at the keyframe, which odometry would not have accepted, are not
/// slips. A keyframe has not slipped either if a later one was registered only with keyframes
/// before it. Empty as well if both ends of the loop were taken in different maps. `keyframes` are
/// in the order of their ids, from 0.
std::optional<Slip> find_slip(const PoseEdge& loop, std::span<const Keyframe> keyframes,
                              std::span<const PoseEdge> edges, const CameraModel& camera,
                              const LoopOptions& options, const RegistrationOptions& registration);

/// Edges without the slip: those of odometry that lead from a keyframe before it to a later one are
/// replaced by those of the slip. Loops stay, in their order.
std::vector<PoseEdge> without_slip(std::span<const PoseEdge> edges, const Slip& slip);

}  // namespace tofmap
