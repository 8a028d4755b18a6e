// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

/// The loop that agrees with most others, and these others, in the given order. Two loops agree if
/// the correction of the path by one of them moves the later keyframe of the other one to where
/// that one puts it, within two standard deviations of the drift between both. `keyframes` are in
/// the order of their ids, from 0. Empty if there are no loops.
std::vector<const PoseEdge*> most_that_agree(const std::vector<const PoseEdge*>& loops,
                                             std::span<const Keyframe> keyframes,
                                             const LoopOptions& options);

/// Whether a loop would move its later keyframe by more than frames can be registered across
/// (KeyframeGraph::well_connected_sigma_m), or what that sees at a distance of a metre.
bool would_move(const PoseEdge& loop, std::span<const Keyframe> keyframes);

/// Poses of keyframes that fit odometry and loops.
struct LoopFit {
  std::vector<Pose> poses;               ///< in the order of the keyframes
  std::vector<double> edge_mahalanobis;  ///< Mahalanobis distance of each edge at these poses
  std::vector<bool> is_used;             ///< for each edge, whether the poses follow it
};

/// Optimises the poses of keyframes over the edges between them (optimise_pose_graph()).
///
/// A loop that would move its keyframe needs support: it is left out unless at least two other
/// loops agree with it. Loops among the others that the kernel rejects are not used either.
///
/// The covariances of edges only cover noise. Errors that all frames share, such as a periodic
/// error of ranges, add up along the path to much more, so that correct loops would be rejected.
/// Wrong loops do not agree with each other. Therefore, if more than half of the supported loops
/// agree with each other, but most of these are rejected, the path is taken to be wrong. The poses
/// are then optimised again with only these loops, and with larger covariances of the other edges,
/// which allow for a drift of `drift_share` of the path's length and of all turns.
///
/// The first `held` keyframes stay where they are.
LoopFit fit_loops(std::span<const Keyframe> keyframes, std::span<const PoseEdge> edges,
                  const LoopOptions& options, std::size_t held = 0);

}  // namespace tofmap
