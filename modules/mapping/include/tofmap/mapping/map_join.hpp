// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

/// The relative pose of two maps of one recording.
struct MapJoin {
  int into = 0;  ///< the map whose world frame is kept
  int map = 0;   ///< the map that is joined to it
  Pose into_from_map = Pose::Identity();
  std::vector<PoseEdge> edges;  ///< the recognitions that agree on this pose
};

/// Why a map was not joined with another one.
enum class JoinObstacle {
  none,          ///< it was
  too_few,       ///< too few keyframes agree on a place
  contradicted,  ///< keyframes agree on places, but see through surfaces that are there
  ambiguous,     ///< keyframes fit to several places, to each nearly as well
};

/// Number of keyframes that must recognise the same place. One alone may be wrong: places look
/// alike.
inline constexpr std::size_t least_agreeing_keyframes = 3;

/// Number of keyframes that recognitions are of.
std::size_t recognising_keyframes(const std::vector<const PoseEdge*>& recognitions);

/// Pointers to edges, valid as long as these stay where they are.
std::vector<const PoseEdge*> pointers_to(std::span<const PoseEdge> edges);

/// The join of `map` that recognitions agree on: the relative pose is that of the recognition that
/// puts the keyframes of all of them nearest to where they were recognised. `keyframes` are in the
/// order of their ids, from 0.
MapJoin join_by(const std::vector<const PoseEdge*>& recognitions, int map,
                std::span<const Keyframe> keyframes);

/// Searches for a map that `map` can be joined with. `recognitions` are edges between keyframes of
/// different maps, from the map that was there first.
///
/// Recognitions by at least `least_agreeing_keyframes` keyframes of `map` must agree with each
/// other, as loops agree (fit_loops()), and must be more than half of all recognitions between both
/// maps. Of several maps, the one with the most recognitions that agree is chosen. Empty if there
/// is none. `keyframes` are in the order of their ids, from 0.
std::optional<MapJoin> find_join(std::span<const PoseEdge> recognitions, int map,
                                 std::span<const Keyframe> keyframes, const LoopOptions& options);

}  // namespace tofmap
