// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe_graph.hpp>
#include <tofmap/mapping/map_join.hpp>

namespace tofmap {

/// Keyframes within this many keyframe spacings of each other see mostly the same.
inline constexpr double steps_of_same_view = 3;

/// The keyframe nearest to a pose, of those that count and see mostly the same from there. Null if
/// there is none.
const Keyframe* nearest_view(const Pose& pose, std::span<const Keyframe> keyframes,
                             const KeyframeSpacing& spacing,
                             const std::function<bool(const Keyframe&)>& counts);

/// Whether the map of a recording can be joined with one of earlier recordings, if nothing tells
/// how the camera came there: places look alike. `recognitions` are edges from keyframes of earlier
/// recordings to some of the map: all places that each of these may see, right and wrong ones.
///
/// Another place where at least two keyframes agree, and which is possible, is a runner-up. The
/// keyframes of the map are put there, and compared with the free space of the nearest ones of the
/// other map (free_space_violation_share()). The join is certain if they contradict each runner-up
/// clearly more than the place of the join, and that by less than 30 % of what both see.
/// `keyframes` are in the order of their ids, from 0.
bool is_certain(const MapJoin& join, std::span<const PoseEdge> recognitions,
                const std::function<bool(const MapJoin&)>& is_possible,
                std::span<const Keyframe> keyframes, const CameraModel& camera,
                const KeyframeSpacing& spacing, const LoopOptions& options);

}  // namespace tofmap
