// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/mapping/map_content.hpp>
#include <tofmap/mapping/odometry.hpp>

namespace tofmap {

/// Mends the start of a map that was begun in front of surfaces that leave a degenerate direction
/// of motion, such as a bare wall. How the camera moved was not known yet then, so that its first
/// keyframes may be far off in that direction.
///
/// These keyframes are registered again, from the last one backwards, from where the motion of the
/// camera after them puts them, and the edges of odometry between them are replaced. Returns their
/// ids, in order; empty if the start of the map is certain, by odometry or by loops, or if the
/// keyframes do not fit where they are put. Then nothing is changed.
///
/// `taken_in` is Keyframe::taken_in of the map. RegisteredFrame::covariance must be what the
/// surfaces alone tell.
std::vector<int> mend_uncertain_start(MapContent& content, int taken_in,
                                      const OdometryOptions& odometry,
                                      const RegistrationOptions& registration,
                                      const LoopOptions& recognition);

}  // namespace tofmap
