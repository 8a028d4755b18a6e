// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper checks a join of maps by what later frames show, and takes it back.

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/place_recognition.hpp"
#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace tofmap {
namespace {

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

/// What the keyframes of a map tell about its join with another one.
JoinEvidence RoomMapper::evidence_of(const MapJoin& join) const {
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

/// Whether evidence refutes a join with the map `into`.
bool RoomMapper::refutes_join(const JoinEvidence& evidence, int into) const {
  return evidence.refutes(is_of_earlier_recording(into));
}

/// Checks the join of the newest map by the newest keyframe.
void RoomMapper::check_join() {
  if (!is_joined()) return;
  evidence_.add(differs_from_others(content_.keyframes[content_.keyframes.size() - 1]));
  if (refutes_join(evidence_, map_)) {
    refute_join();
    return;
  }
  const auto is_own_keyframe = [&](const Keyframe& keyframe) { return is_own(keyframe); };
  if (are_places_compared_at(std::ranges::count_if(content_.keyframes.all(), is_own_keyframe))) {
    review_join_of_newest(false);
  }
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
    refute_join();
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

/// Compares the place of the newest map in that of earlier recordings, which it was joined with,
/// with other places. If another one is certain now, the map is joined there instead. At the end,
/// fewer keyframes must agree, and the join is taken back if no place is certain.
void RoomMapper::review_join_of_newest(bool at_the_end) {
  if (!is_joined() || !is_of_earlier_recording(map_)) return;
  const auto all = content_.keyframes.all();
  std::vector<Keyframe> apart(all.begin(), all.end());
  for (Keyframe& keyframe : apart) {
    if (is_own(keyframe)) keyframe.map = newest_map();
  }
  const MapJoin join{.into = map_, .map = newest_map(), .edges = {}};
  const KeyframeSpacing spacing = keyframe_spacing();
  const std::vector<Stretch> travelled = stretches(apart);
  const JoinReview review =
      review_join(join, possible_places_, possible_after(travelled, apart),
                  {apart, camera_, spacing, loop_options_, registration_},
                  at_the_end ? least_agreeing_keyframes : least_agreeing_so_far);
  if (!review.elsewhere && (review.obstacle == JoinObstacle::none || !at_the_end)) return;
  nearness_.obstacle = review.obstacle;
  if (!review.elsewhere) return take_join_back();
  refute_join();
  this->join(join_by(pointers_to(review.elsewhere->edges), map_, content_.keyframes.all()),
             stretches(content_.keyframes.all()));
}

/// Takes a join back since its place is the wrong one, and forgets that keyframes of the newest map
/// recognise this place of earlier recordings.
void RoomMapper::refute_join() {
  const auto is_followed = [&](const PoseEdge& edge) {
    const Keyframe& from = content_.keyframes[edge.from];
    const Keyframe& to = content_.keyframes[edge.to];
    return is_own(to) && !connects_maps(edge) &&
           are_near(from.world_from_camera * edge.from_from_to, to.world_from_camera,
                    recognition_reach_m, recognition_reach_rad);
  };
  std::erase_if(recognitions_, is_followed);
  std::erase_if(possible_places_, is_followed);
  take_join_back();
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

/// Drops the edges, and with them the loops, between keyframes of different maps, and the
/// constraints of frames with keyframes of another map.
void RoomMapper::drop_edges_between_maps() {
  const auto is_between = [&](const PoseEdge& edge) { return connects_maps(edge); };
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
  for (RegisteredFrame& frame : content_.frames) {
    const int map = content_.keyframes[frame.keyframe].map;
    std::erase_if(frame.constraints, [&](const FrameConstraint& constraint) {
      return content_.keyframes[constraint.keyframe].map != map;
    });
  }
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

}  // namespace tofmap
