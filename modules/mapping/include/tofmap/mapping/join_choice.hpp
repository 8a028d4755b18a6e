// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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

/// Number of keyframes that must agree while others are still to come: of places that look alike,
/// the right one may be recognised last.
inline constexpr std::size_t least_agreeing_so_far = 2 * least_agreeing_keyframes;

/// Whether all places are compared again when a map has this number of keyframes: always up to a
/// dozen, then whenever their number has grown by 7 %. Otherwise the effort, which grows with the
/// number of keyframes, would grow with its square.
bool are_places_compared_at(std::ptrdiff_t keyframes);

/// What the search for a join knows of all maps.
struct JoinContext {
  std::span<const Keyframe> keyframes;  ///< in the order of their ids, from 0
  const CameraModel& camera;
  const KeyframeSpacing& spacing;
  const LoopOptions& loops;
  const RegistrationOptions& registration;
};

/// Tells joins that are possible by what is known of the camera's path.
using IsPossibleJoin = std::function<bool(const MapJoin&)>;

/// Searches for the place of a finished map in others, where it may share little with them.
/// `possible` are edges from keyframes of earlier recordings to some of the map: all places that
/// each of these may see, right and wrong ones.
///
/// Each place where at least two keyframes agree is tried. The other keyframes of the map are put
/// there; those that overlap are registered from there. Together with them, at least
/// `least_agreeing_keyframes` must agree, and the join must be certain. Empty if there is no such
/// place.
///
/// Nothing tells how the camera came there, and places look alike. Another place where at least two
/// keyframes agree, and which is possible, is a runner-up. The keyframes of the map are put there,
/// and compared with the free space of the nearest ones of the other map
/// (free_space_violation_share()). The join is certain if they contradict its place by less than
/// 20 % of what both see, and each runner-up clearly more. For that, only the half of the keyframes
/// counts that contradicts a place least: furniture that was moved is in sight of some of them,
/// while at a place that looks alike all see something else.
std::optional<MapJoin> find_certain_join(int map, std::span<const PoseEdge> possible,
                                         const IsPossibleJoin& is_possible,
                                         const JoinContext& context);

/// The place of a map in those of earlier recordings, as far as keyframes know it.
struct JoinChoice {
  std::optional<MapJoin> join;  ///< if it is certain
  int agreeing = 0;             ///< largest number of sure recognitions that agree
  JoinObstacle obstacle = JoinObstacle::too_few;
};

/// Chooses a place of a map while its recording may go on. Six keyframes must recognise it with
/// certainty, twice as many as at the end, and agree (find_join()). If it is not certain by what
/// contradicts it, another one is searched, where six must agree as well; in a long recording,
/// that is done after every tenth or so of its keyframes, since it takes all of them. `possible`
/// are as for find_certain_join(), `sure` some of them.
JoinChoice choose_join(int map, std::span<const PoseEdge> sure, std::span<const PoseEdge> possible,
                       const IsPossibleJoin& is_possible, const JoinContext& context);

/// What later keyframes tell about a join with a map of earlier recordings.
struct JoinReview {
  JoinObstacle obstacle = JoinObstacle::none;  ///< why the join would not be made now
  std::optional<MapJoin> elsewhere;            ///< the place that is certain now, if there is one
};

/// Compares the place of a join with all others again, since more of the map is known now. In
/// `context`, the keyframes of the map have the map's number, as before the join. `elsewhere` is a
/// place that is certain as for find_certain_join(), if `least_agreeing` keyframes agree there.
/// Without one, other places are an obstacle only if at least half as many keyframes fit there as
/// at the place of the join: in a building whose rooms look alike, only parts of a recording fit to
/// wrong places.
JoinReview review_join(const MapJoin& join, std::span<const PoseEdge> possible,
                       const IsPossibleJoin& is_possible, const JoinContext& context,
                       std::size_t least_agreeing);

}  // namespace tofmap
