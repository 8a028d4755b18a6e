// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/motion_uncertainty.hpp>

namespace tofmap {

/// Fits the poses of all keyframes, and of the frames of a recording, to what all frames tell.
///
/// A keyframe has its pose from a single registration, whose noise stays in the map. But the frames
/// around it were registered with it and with keyframes beside it, and tell their relative poses
/// more precisely together. The least squares problem of all constraints of all frames
/// (RegisteredFrame::constraints), of the edges of odometry, which hold what frames do not
/// constrain, and of the loops that are used, is linearised about the present poses. Each frame has
/// constraints with few keyframes, and is eliminated; the system of the keyframes is sparse
/// (Triggs et al., "Bundle adjustment – a modern synthesis", 2000, section 6.1).
///
/// Where surfaces leave a direction open, for instance along a bare wall, the camera is taken to
/// move steadily through the frames before and after: there, three frames that follow each other
/// have a term more, and stay in the system. `motion` learns how steady the motion is, in each path
/// anew.
///
/// Constraints that a frame is more than 0.1 m or 0.05 rad away from are left out: they are linear
/// up to small errors only, and a loop or a slip has moved keyframes since, or the registration was
/// wrong.
///
/// The first `held` keyframes, and the first one of each map, keep their poses. Edges of odometry
/// get the relative poses that were found, so that later fits of the pose graph keep them, unless
/// they were more than that off, and more than the registration left open.
void fit_path(MapContent& content, int recording, const LoopOptions& options,
              const MotionUncertainty& motion, std::size_t held);

}  // namespace tofmap
