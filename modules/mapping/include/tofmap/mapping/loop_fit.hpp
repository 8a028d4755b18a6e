// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_closure.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

/// The poses of keyframes that fit all edges between them best (optimise_pose_graph()).
///
/// Covariances of edges tell of noise. Errors that all frames share, such as a periodic error of
/// ranges, add up along the path far beyond them, and right loops would be outvoted. So if
/// loops that agree with each other, at least two and most of all, are mostly outvoted, it is the
/// path that is wrong: the fit is made anew with them alone, and with the other edges loosened
/// until they allow for a drift of `drift_share` of the path. A wrong loop has no other to agree
/// with.
PoseGraphResult fit_loops(std::span<const Keyframe> keyframes, std::span<const PoseEdge> edges,
                          const LoopOptions& options);

}  // namespace tofmap
