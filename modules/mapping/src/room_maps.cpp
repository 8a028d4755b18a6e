// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper begins maps, joins them, and takes a join back.

#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/join_choice.hpp"
#include "tofmap/mapping/map_join.hpp"
#include "tofmap/mapping/place_recognition.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace tofmap {
namespace {

/// Smallest number of frames of a map. Fewer show something that passed in front of the camera.
constexpr std::ptrdiff_t least_frames_of_map = 3;

/// Longest time without tracking after which the camera is still near where it was: at walking pace
/// it has gone three metres, hardly into another room.
constexpr double longest_blink_s = 2;

/// Moves what a frame was registered with to another place of the world, and the frame with it.
void move(TrackingResult& result, const Pose& new_from_old_world) {
  const auto rotate = [&](Eigen::Matrix<double, 6, 6>& along_the_axes_of_the_world) {
    along_the_axes_of_the_world = rotated(along_the_axes_of_the_world, new_from_old_world.linear());
  };
  result.world_from_camera = new_from_old_world * result.world_from_camera;
  result.registration.world_from_camera =
      new_from_old_world * result.registration.world_from_camera;
  rotate(result.covariance);
  rotate(result.registration.covariance);
  for (auto& covariance : result.target_covariances) rotate(covariance);
  if (result.since_keyframe) rotate(result.since_keyframe->covariance);
  for (auto& information : result.registration.target_information) rotate(information);
}

}  // namespace

/// Whether the camera can have been carried elsewhere since the last registered frame.
bool RoomMapper::was_blind(double timestamp_s) const {
  return !own_frames().empty() && odometry_.is_after_gap(timestamp_s) &&
         timestamp_s - content_.frames.back().timestamp_s > longest_blink_s;
}

/// Begins a map with the frames that could not be registered, in order. Returns what became of
/// them, and of the frames of a map before that was too small to keep.
std::vector<LateFrame> RoomMapper::start_map() {
  std::vector<LateFrame> late = drop_fragment();
  map_ = begun_maps_++;
  odometry_.start_anew();
  lost_frames_ = 0;
  for (NewFrame& frame : std::exchange(held_, {})) {
    TrackingResult tracking = track(frame);
    if (tracking.registered()) integrate(*frame.cloud);
    late.push_back({frame.index, std::move(tracking), frame.cloud});
  }
  return late;
}

/// Removes the newest map if it has too few frames to be of use. Nothing refers to it then but
/// what was added last.
std::vector<LateFrame> RoomMapper::drop_fragment() {
  const auto is_of_newest = [&](const RegisteredFrame& frame) {
    return content_.keyframes[frame.keyframe].map == map_;
  };
  const auto first = std::ranges::find_if(content_.frames, is_of_newest);
  if (map_ + 1 != begun_maps_ || content_.frames.end() - first >= least_frames_of_map) return {};
  std::vector<LateFrame> dropped;
  for (auto frame = first; frame != content_.frames.end(); ++frame) {
    dropped.push_back({frame->index, TrackingResult{}, nullptr});
  }
  content_.frames.erase(first, content_.frames.end());
  const auto is_kept = [&](const Keyframe& keyframe) { return keyframe.map != map_; };
  const auto kept = static_cast<int>(std::ranges::count_if(content_.keyframes.all(), is_kept));
  const auto refers_to_dropped = [&](const PoseEdge& edge) { return edge.to >= kept; };
  std::erase_if(content_.edges, refers_to_dropped);
  const auto kept_loops = std::ranges::count_if(content_.edges, &PoseEdge::may_be_wrong);
  const auto dropped_loops = static_cast<int>(std::ssize(content_.loops) - kept_loops);
  unfitted_loops_ = std::max(0, unfitted_loops_ - dropped_loops);  // the newest ones
  content_.loops.resize(static_cast<std::size_t>(kept_loops));
  std::erase_if(recognitions_, refers_to_dropped);
  std::erase_if(possible_places_, refers_to_dropped);
  std::erase_if(content_.submaps, [&](const Submap& submap) { return submap.anchor >= kept; });
  content_.submap_of.resize(static_cast<std::size_t>(kept));
  content_.keyframes.shrink(kept);
  searched_ = std::min(searched_, kept);
  last_slip_search_ = std::min(last_slip_search_, kept - 1);
  return dropped;
}

/// Searches for the place of the newest keyframe in those other maps that the camera can have
/// travelled to, and joins maps if enough keyframes agree.
void RoomMapper::recognise_place() {
  const auto is_of_this = [&](const Keyframe& other) { return other.map == map_; };
  if (std::ranges::all_of(content_.keyframes.all(), is_of_this)) return;
  const Keyframe& keyframe = content_.keyframes[content_.keyframes.size() - 1];
  const std::vector<Stretch> travelled = stretches();
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
  const auto is_possible = [&](const Keyframe& other, const Pose& pose) {
    const MapJoin place = join_at(other, pose);
    return can_travel(travelled, place) && agrees_with_start(place);
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

/// Whether a join puts the beginning of the recording into the direction that go_on_with() was
/// told.
bool RoomMapper::agrees_with_start(const MapJoin& join) const {
  constexpr double most_rad = M_PI / 4;
  if (!start_ || !start_->has_rotation) return true;
  const RegisteredFrame& first = own_frames().front();
  if (content_.keyframes[first.keyframe].map != join.map) return true;
  const Pose joined = join.into_from_map * pose_of(first, content_.keyframes);
  return Eigen::AngleAxisd(start_->world_from_camera.linear().transpose() * joined.linear())
             .angle() <= most_rad;
}

/// The path of the camera through the maps.
std::vector<Stretch> RoomMapper::stretches() const {
  std::vector<Stretch> stretches;
  if (start_ && !own_frames().empty()) {
    add_position(stretches, start_->map, own_frames().front().timestamp_s,
                 start_->world_from_camera.translation());
  }
  for (const RegisteredFrame& frame : own_frames()) {
    add_position(stretches, content_.keyframes[frame.keyframe].map, frame.timestamp_s,
                 pose_of(frame, content_.keyframes).translation());
  }
  return stretches;
}

/// The join of the newest map with one of the same recording or, if there is none, with one of
/// earlier recordings.
std::optional<MapJoin> RoomMapper::found_join(std::span<const Stretch> travelled) {
  std::vector<PoseEdge> own;
  std::vector<PoseEdge> earlier;
  for (const PoseEdge& edge : recognitions_) {
    (content_.keyframes[edge.from].recording < recording() ? earlier : own).push_back(edge);
  }
  const auto all = content_.keyframes.all();
  if (auto join = find_join(own, map_, all, loop_options_)) return join;
  const auto is_possible = [&](const MapJoin& place) {
    return can_travel(travelled, place) && agrees_with_start(place);
  };
  const KeyframeSpacing spacing = keyframe_spacing();
  const JoinChoice choice = choose_join(map_, earlier, possible_places_, is_possible,
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
  const auto is_joined_now = [&](const PoseEdge& edge) {
    return content_.keyframes[edge.from].map == content_.keyframes[edge.to].map;
  };
  std::erase_if(recognitions_, is_joined_now);
  std::erase_if(possible_places_, is_joined_now);
  fit();
}

/// Joins maps of the recording with those of earlier ones, now that all of their keyframes are
/// known, and closes the loops between them.
void RoomMapper::join_afterwards() {
  const KeyframeSpacing spacing = keyframe_spacing();
  std::set<int> maps;
  for (const PoseEdge& edge : possible_places_) maps.insert(content_.keyframes[edge.to].map);
  for (const int map : maps) {
    const std::vector<Stretch> travelled = stretches();  // a join before has moved them
    const auto is_possible = [&](const MapJoin& place) {
      return can_travel(travelled, place) && agrees_with_start(place);
    };
    const auto found = find_certain_join(
        map, possible_places_, is_possible,
        {content_.keyframes.all(), camera_, spacing, loop_options_, registration_});
    if (!found || refutes_join(evidence_of(*found), found->into)) continue;
    std::vector<int> joined;
    for (const Keyframe& keyframe : content_.keyframes.all()) {
      if (keyframe.map == map) joined.push_back(keyframe.id);
    }
    join(*found, travelled);
    if (loop_options_.close) close_loops_of(joined);
  }
}

void RoomMapper::JoinEvidence::add(std::optional<bool> differs) {
  compared += differs ? 1 : 0;
  differing += differs.value_or(false) ? 1 : 0;
}

/// What the keyframes of a map tell of its join with another one: places of one plan differ in what
/// was put there.
RoomMapper::JoinEvidence RoomMapper::evidence_of(const MapJoin& join) const {
  JoinEvidence evidence;
  for (const Keyframe& keyframe : content_.keyframes.all()) {
    if (keyframe.map != join.map) continue;
    Keyframe moved = keyframe;
    moved.map = join.into;
    moved.world_from_camera = join.into_from_map * keyframe.world_from_camera;
    evidence.add(differs_from_others(moved));
  }
  return evidence;
}

/// Whether the newest map is not part of the map `into`: at least two of its keyframes differ from
/// that (a single one may be wrong). Since earlier recordings, things may have been moved. Then it
/// takes more than half of the keyframes.
bool RoomMapper::refutes_join(const JoinEvidence& evidence, int into) const {
  constexpr int least_differing = 2;
  if (evidence.differing < least_differing) return false;
  return !is_of_earlier_recording(into) || 2 * evidence.differing > evidence.compared;
}

/// Whether earlier recordings have keyframes in a map.
bool RoomMapper::is_of_earlier_recording(int map) const {
  return std::ranges::any_of(content_.keyframes.all(), [&](const Keyframe& keyframe) {
    return keyframe.map == map && keyframe.recording < recording();
  });
}

/// Whether a keyframe of the newest map sees a region that stands in free space of another one that
/// it was joined with, or sees through one there, or contradicts it as a whole. Empty if no other
/// one sees the same.
std::optional<bool> RoomMapper::differs_from_others(const Keyframe& keyframe) const {
  const Keyframe* other = keyframe_near(keyframe.world_from_camera, keyframe.map);
  if (other == nullptr) return std::nullopt;
  const ComparedKeyframe compared{other, {}};
  const Motion motion = MovingRegions(camera_).find(keyframe.cloud.load(),
                                                    keyframe.world_from_camera, {&compared, 1});
  // Between recordings, furniture may have been moved.
  return motion.contradicts_pose || (other->recording == keyframe.recording && !motion.is_empty());
}

/// Whether a frame of the newest map shows another place than a keyframe that it is near.
bool RoomMapper::is_of_another_place(const RegistrationTarget& frame, const Keyframe& other) const {
  return contradicts_free_space(
      frame, target_of(other), camera_,
      other.recording == recording() ? most_violations : most_violations_since);
}

/// Registers a frame with the keyframes of its own map alone, after that with all keyframes of the
/// maps that were joined has failed. If it fits the one and contradicts the others, the join is
/// taken back.
TrackingResult RoomMapper::track_apart(NewFrame& frame, std::span<const Keyframe* const> around) {
  TrackingResult result = track_with(own(around), frame).tracking;
  if (!result.registered()) return result;
  const Keyframe* other = keyframe_near(result.world_from_camera, map_);
  if (other != nullptr &&
      is_of_another_place({frame.cloud.get(), result.world_from_camera}, *other)) {
    evidence_.add(true);
    if (other->recording != recording() && !refutes_join(evidence_, map_)) return result;
    const Pose before = content_.keyframes[current_].world_from_camera;
    take_join_back();
    move(result, content_.keyframes[current_].world_from_camera * before.inverse());
  }
  return result;
}

/// Registers a frame with the keyframes of its own recording alone, after the registration with all
/// keyframes has fitted badly: what moved between recordings is in the way. Empty, with odometry
/// and clouds as they were, unless that fits clearly better. Takes what moves out of the frame.
std::optional<StillTracking> RoomMapper::track_undisturbed(NewFrame& frame,
                                                           std::span<const Keyframe* const> around,
                                                           const StillTracking& disturbed,
                                                           const StillOdometry& before) {
  constexpr double badly = 1.5;    // residuals relative to the noise; 1 is usual
  constexpr double better = 0.67;  // share of the residuals
  const double scale = disturbed.tracking.registration.residual_scale;
  if (scale < badly || !is_of_earlier_recording(map_)) return std::nullopt;
  StillOdometry joined = std::exchange(odometry_, before);
  // At a wrong pose, all seems to move: that must not be taken out of keyframes.
  const auto cleaned = exchange_clouds(disturbed.before, content_.keyframes);
  StillTracking found = track_with(own(around), frame);
  const TrackingResult& result = found.tracking;
  if (result.registered() && result.registration.residual_scale < better * scale) return found;
  exchange_clouds(found.before, content_.keyframes);
  exchange_clouds(cleaned, content_.keyframes);
  odometry_ = std::move(joined);
  return std::nullopt;
}

/// Undoes the joins that keyframes of the newest map have led to.
void RoomMapper::take_join_back() {
  const auto taken_back =
      std::erase_if(joins_, [&](const JoinedMaps& join) { return join.found_in == newest_map(); });
  joins_taken_back_ += static_cast<int>(taken_back);
  connect_own_keyframes();
  std::vector<int> map_of(static_cast<std::size_t>(begun_maps_));
  std::iota(map_of.begin(), map_of.end(), 0);
  for (const JoinedMaps& join : joins_) std::ranges::replace(map_of, join.map, join.into);
  content_.keyframes.assign_maps(map_of);
  drop_edges_between_maps();
  map_ = newest_map();
  evidence_ = {};
  fit();
  for (const int map : map_of) return_to_origin(map);
}

/// Gives an edge to each keyframe of the newest map that is connected with earlier ones of its map
/// only over those of other maps.
void RoomMapper::connect_own_keyframes() {
  std::set<int> connected;
  for (const PoseEdge& edge : content_.edges) {
    if (is_own(content_.keyframes[edge.from]) && edge.from < edge.to) connected.insert(edge.to);
  }
  for (const Keyframe& keyframe : content_.keyframes.all()) {
    if (!is_own(keyframe) || connected.contains(keyframe.id)) continue;
    const auto spreads = content_.keyframes.spreads_from(keyframe.id);
    const Keyframe* nearest = nullptr;
    PoseSpread least;
    for (const Keyframe& earlier :
         content_.keyframes.all().first(static_cast<std::size_t>(keyframe.id))) {
      const auto& spread = spreads[static_cast<std::size_t>(earlier.id)];
      if (!is_own(earlier) || !spread) continue;
      if (nearest != nullptr && spread->translation_m2 >= least.translation_m2) continue;
      nearest = &earlier;
      least = *spread;
    }
    if (nearest == nullptr) continue;  // the first one
    PoseEdge edge{.from = nearest->id, .to = keyframe.id};
    edge.from_from_to = nearest->world_from_camera.inverse() * keyframe.world_from_camera;
    edge.covariance.diagonal() << Eigen::Vector3d::Constant(least.rotation_rad2),
        Eigen::Vector3d::Constant(least.translation_m2);
    content_.edges.push_back(edge);
    content_.keyframes.connect(edge.from, edge.to, least);
  }
}

/// Drops the edges, and with them the loops, between keyframes of different maps.
void RoomMapper::drop_edges_between_maps() {
  const auto is_between = [&](const PoseEdge& edge) {
    return content_.keyframes[edge.from].map != content_.keyframes[edge.to].map;
  };
  const auto fitted = static_cast<std::ptrdiff_t>(content_.loops.size()) - unfitted_loops_;
  std::vector<Loop> kept;
  std::ptrdiff_t index = 0;
  unfitted_loops_ = 0;
  for (const PoseEdge& edge : content_.edges) {
    if (!edge.may_be_wrong) continue;
    if (!is_between(edge)) {
      kept.push_back(content_.loops[static_cast<std::size_t>(index)]);
      unfitted_loops_ += index >= fitted ? 1 : 0;
    }
    ++index;
  }
  content_.loops = std::move(kept);
  std::erase_if(content_.edges, is_between);
}

/// Moves a map so that its first keyframe is the origin of its world.
void RoomMapper::return_to_origin(int map) {
  const auto first = std::ranges::find(content_.keyframes.all(), map, &Keyframe::map);
  if (first == content_.keyframes.all().end() || first->recording < recording()) return;
  const Pose origin_from_world = first->world_from_camera.inverse();
  content_.keyframes.join(map, map, origin_from_world);
  if (map != map_) return;
  odometry_.move(origin_from_world);
}

/// The keyframe of a map that is nearest to a pose, among those of maps that the newest one was
/// joined with. Null if none sees mostly the same.
const Keyframe* RoomMapper::keyframe_near(const Pose& pose, int map) const {
  return nearest_view(
      pose, content_.keyframes.all(), keyframe_spacing(),
      [&](const Keyframe& keyframe) { return keyframe.map == map && !is_own(keyframe); });
}

int RoomMapper::blind_joins() const {
  return static_cast<int>(std::ranges::count_if(joins_, &JoinedMaps::is_blind));
}

}  // namespace tofmap
