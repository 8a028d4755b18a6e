// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper finds the place of a map in others, and joins them.

#include "tofmap/mapping/map_join.hpp"
#include "tofmap/mapping/place_recognition.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace tofmap {
namespace {

/// Longest time without tracking after which the camera is still near where it was: at walking pace
/// it has gone three metres, hardly into another room.
constexpr double longest_blink_s = 2;

}  // namespace

/// Whether the camera can have been carried elsewhere since the last registered frame.
bool RoomMapper::was_blind(double timestamp_s) const {
  return !own_frames().empty() && odometry_.is_after_gap(timestamp_s) &&
         timestamp_s - content_.frames.back().timestamp_s > longest_blink_s;
}

int RoomMapper::blind_joins() const {
  return static_cast<int>(std::ranges::count_if(joins_, &JoinedMaps::is_blind));
}

/// The path of the camera through the maps that keyframes are in.
std::vector<Stretch> RoomMapper::stretches(std::span<const Keyframe> keyframes) const {
  std::vector<Stretch> stretches;
  if (start_ && !own_frames().empty()) {
    add_position(stretches, start_->map, own_frames().front().timestamp_s,
                 start_->world_from_camera.translation());
  }
  for (const RegisteredFrame& frame : own_frames()) {
    const Keyframe& keyframe = keyframes[static_cast<std::size_t>(frame.keyframe)];
    add_position(stretches, keyframe.map, frame.timestamp_s,
                 (keyframe.world_from_camera * frame.keyframe_from_camera).translation());
  }
  return stretches;
}

/// Whether a join puts the beginning of the recording into the direction that go_on_with() was
/// told.
bool RoomMapper::agrees_with_start(const MapJoin& join, std::span<const Keyframe> keyframes) const {
  constexpr double most_rad = M_PI / 4;
  if (!start_ || !start_->has_rotation) return true;
  const RegisteredFrame& first = own_frames().front();
  const Keyframe& keyframe = keyframes[static_cast<std::size_t>(first.keyframe)];
  if (keyframe.map != join.map) return true;
  const Pose joined = join.into_from_map * keyframe.world_from_camera * first.keyframe_from_camera;
  return Eigen::AngleAxisd(start_->world_from_camera.linear().transpose() * joined.linear())
             .angle() <= most_rad;
}

/// Tells the joins that the camera's path through the maps, and the start that it was given, allow.
/// `travelled` are the stretches of the keyframes. Both must live as long as the result.
IsPossibleJoin RoomMapper::possible_after(std::span<const Stretch> travelled,
                                          std::span<const Keyframe> keyframes) const {
  return [this, travelled, keyframes](const MapJoin& join) {
    return can_travel(travelled, join) && agrees_with_start(join, keyframes);
  };
}

/// Searches for the place of the newest keyframe in those other maps that the camera can have
/// travelled to, and joins maps if enough keyframes agree.
void RoomMapper::recognise_place() {
  const auto is_of_this = [&](const Keyframe& other) { return other.map == map_; };
  if (std::ranges::all_of(content_.keyframes.all(), is_of_this)) return;
  const Keyframe& keyframe = content_.keyframes[content_.keyframes.size() - 1];
  const std::vector<Stretch> travelled = stretches(content_.keyframes.all());
  const auto join_at = [&](const Keyframe& other, const Pose& pose) {
    return MapJoin{.into = other.map,
                   .map = map_,
                   .into_from_map = pose * keyframe.world_from_camera.inverse(),
                   .edges = {}};
  };
  // The camera may be some way from the keyframe that recognises it, and turned, which moves the
  // beginning of its map.
  const double since_begin_m =
      (keyframe.world_from_camera.translation() - travelled.back().begin_m).norm();
  const double near_m =
      travel_tolerance_m + recognition_reach_m + recognition_reach_rad * since_begin_m;
  std::vector<const Keyframe*> candidates;
  for (const Keyframe& other : content_.keyframes.all()) {
    if (!is_of_this(other) &&
        can_travel(travelled, join_at(other, other.world_from_camera), near_m)) {
      candidates.push_back(&other);
    }
  }
  const auto is_possible_join = possible_after(travelled, content_.keyframes.all());
  const auto is_possible = [&](const Keyframe& other, const Pose& pose) {
    return is_possible_join(join_at(other, pose));
  };
  recognise_among(keyframe, std::move(candidates), is_possible);
  join_maps(travelled);
}

/// Adds the places of other maps that a keyframe recognises: those that are certain, and all of
/// earlier recordings.
void RoomMapper::recognise_among(const Keyframe& keyframe, std::vector<const Keyframe*> candidates,
                                 const IsPossiblePlace& is_possible) {
  std::vector<const Keyframe*> earlier;
  std::ranges::copy_if(candidates, std::back_inserter(earlier), [&](const Keyframe* candidate) {
    return candidate->recording < recording();
  });
  std::erase_if(candidates,
                [&](const Keyframe* candidate) { return candidate->recording < recording(); });
  if (!earlier.empty()) ++nearness_.keyframes;
  for (const auto& of_one_kind : {candidates, earlier}) {
    if (of_one_kind.empty()) continue;
    const auto all = content_.keyframes.all();
    const RecognisedPlaces places = recognise_places(keyframe, of_one_kind, is_possible, all,
                                                     camera_, loop_options_, registration_);
    const bool is_of_earlier = of_one_kind.front()->recording < recording();
    if (is_of_earlier) std::ranges::copy(places.possible, std::back_inserter(possible_places_));
    if (!places.surest) continue;
    recognitions_.push_back(*places.surest);
    if (is_of_earlier) ++nearness_.recognised;
  }
}

/// The join of the newest map with one of the same recording or, if there is none, with one of
/// earlier recordings.
std::optional<MapJoin> RoomMapper::found_join(std::span<const Stretch> travelled) {
  std::vector<PoseEdge> own;
  std::vector<PoseEdge> earlier;
  for (const PoseEdge& edge : recognitions_) {
    if (!connects_maps(edge)) continue;  // joined already
    const bool is_earlier = content_.keyframes[edge.from].recording < recording();
    (is_earlier ? earlier : own).push_back(edge);
  }
  const auto all = content_.keyframes.all();
  if (auto join = find_join(own, map_, all, loop_options_)) return join;
  const KeyframeSpacing spacing = keyframe_spacing();
  const JoinChoice choice =
      choose_join(map_, earlier, possible_places_, possible_after(travelled, all),
                  {all, camera_, spacing, loop_options_, registration_});
  nearness_.agreeing = choice.agreeing;
  // Later keyframes may disagree with a place that was ambiguous, and make none certain.
  if (choice.obstacle != JoinObstacle::too_few) nearness_.obstacle = choice.obstacle;
  return choice.join;
}

/// Joins the newest map with another one if enough recognitions agree. `travelled` are stretches().
void RoomMapper::join_maps(std::span<const Stretch> travelled) {
  const auto join = found_join(travelled);
  if (!join) return;
  const JoinEvidence evidence = evidence_of(*join);
  if (refutes_join(evidence, join->into)) return;
  evidence_ = {.compared = evidence_.compared + evidence.compared,
               .differing = std::max(evidence_.differing, evidence.differing)};
  this->join(*join, travelled);
}

void RoomMapper::join(const MapJoin& join, std::span<const Stretch> travelled) {
  const auto gap =
      std::ranges::adjacent_find(travelled, [&](const Stretch& one, const Stretch& next) {
        return next.map == join.map && next.begin_s - one.end_s > longest_blink_s;
      });
  joins_.push_back({.map = join.map,
                    .into = join.into,
                    .found_in = newest_map(),
                    .is_blind = gap != travelled.end()});
  content_.keyframes.join(join.map, join.into, join.into_from_map);
  if (map_ == join.map) {
    odometry_.move(join.into_from_map);
    map_ = join.into;
  }
  for (const PoseEdge& edge : join.edges) add_loop(edge);
  // Places of earlier recordings are compared again when more is known (review_join()).
  std::erase_if(recognitions_, [&](const PoseEdge& edge) {
    return !connects_maps(edge) && content_.keyframes[edge.from].recording == recording();
  });
  fit();
}

/// Joins maps of the recording with those of earlier ones, now that all of their keyframes are
/// known, and closes the loops between them.
void RoomMapper::join_afterwards() {
  const KeyframeSpacing spacing = keyframe_spacing();
  std::set<int> maps;
  for (const PoseEdge& edge : possible_places_) {
    if (connects_maps(edge)) maps.insert(content_.keyframes[edge.to].map);
  }
  for (const int map : maps) {
    const auto all = content_.keyframes.all();
    const std::vector<Stretch> travelled = stretches(all);  // a join before has moved them
    const auto found = find_certain_join(map, possible_places_, possible_after(travelled, all),
                                         {all, camera_, spacing, loop_options_, registration_});
    if (!found || refutes_join(evidence_of(*found), found->into)) continue;
    std::vector<int> joined;
    for (const Keyframe& keyframe : content_.keyframes.all()) {
      if (keyframe.map == map) joined.push_back(keyframe.id);
    }
    join(*found, travelled);
    if (loop_options_.close) close_loops_of(joined);
  }
}

}  // namespace tofmap
