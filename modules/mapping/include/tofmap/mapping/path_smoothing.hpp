// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/motion_uncertainty.hpp>

namespace tofmap {

/// Smooths the path of a recording between its keyframes, whose poses are held: a frame that the
/// surfaces leave uncertain in some direction is moved there so that the camera moves steadily
/// through the frames before and after it. When frames were tracked, only the motion before them
/// was known, and keyframes may have been moved by loops since.
///
/// A frame counts as at most five times as certain, in each direction, as the frames beside it: a
/// camera sees nearly the same from one frame to the next, and what holds a single frame in a
/// direction is probably an edge that was taken for another.
///
/// RegisteredFrame::covariance must be what the surfaces alone tell; it becomes that of the
/// smoothed pose. `motion` learns how steady the motion is, in each path anew. A fixed-interval
/// smoother (Rauch, Tung and Striebel, AIAA Journal 1965) for constant velocity, linear about the
/// poses as they are.
void smooth_path(MapContent& content, int recording, const MotionUncertainty& motion);

}  // namespace tofmap
