// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/odometry.hpp>

namespace tofmap {

/// The constraints that its registration gives a frame: one with each keyframe. `keyframes` must
/// have the poses that the frame was registered at.
std::vector<FrameConstraint> constraints_of(const TrackingResult& result,
                                            const KeyframeGraph& keyframes);

/// Fits the poses of the keyframes and frames of a recording to what all of its frames tell.
///
/// A keyframe has its pose from a single registration, whose noise stays in the map. But the frames
/// around it were registered with it and with keyframes beside it, and tell their relative poses
/// more precisely together. The least squares problem of all constraints of all frames
/// (RegisteredFrame::constraints), of the edges of odometry, which hold what frames do not
/// constrain, and of the loops that are used, is linearised about the present poses. Each frame has
/// constraints with few keyframes, and is eliminated; the system of the keyframes is sparse
/// (Triggs et al., "Bundle adjustment – a modern synthesis", 2000, section 6.1).
///
/// The first `held` keyframes, and the first one of each map, keep their poses. Edges of odometry
/// of the recording get the relative poses that were found, so that later fits of the pose graph
/// keep them. If the constraints do not determine the poses, they stay.
void fit_path(MapContent& content, int recording, const LoopOptions& options, std::size_t held);

}  // namespace tofmap
