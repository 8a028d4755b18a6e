// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/room_mapper.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <tofmap/core/timed.hpp>

namespace tofmap {
namespace {

/// Number of failed frames with a surface after which a new map begins. A single one may be a bad
/// frame.
constexpr std::size_t frames_until_lost = 3;

/// Number of failed frames after which the motion before no longer predicts the camera's pose.
constexpr int frames_until_given_up = 15;

/// A keyframe with more than this many newer ones belongs to an earlier visit. New keyframes are
/// taken at twice the distance there.
constexpr int recent_keyframes = 15;
constexpr double steps_on_earlier_visits = 2;

/// Share of the distance at which keyframes are taken while a loop awaits others.
constexpr double share_for_loops = 0.5;

/// Keyframes within this many keyframe spacings of an anchor share its submap, since their relative
/// poses hardly change any more.
constexpr double submap_radius_steps = 4;

}  // namespace

RoomMapper::RoomMapper(const CameraModel& camera, const OdometryOptions& odometry,
                       const RegistrationOptions& registration, const LoopOptions& loops,
                       const SurfaceMapOptions& surface)
    : camera_(camera),
      odometry_options_(odometry),
      registration_(registration),
      loop_options_(loops),
      odometry_(camera, odometry, registration, loops),
      content_(camera, surface) {
  content_.recordings.emplace_back().sensor.camera = camera;
}

void RoomMapper::describe_recording(MapRecording recording) {
  content_.recordings.back() = std::move(recording);
}

void RoomMapper::go_on_with(MapContent finished, MapRecording recording, MapUse use,
                            std::optional<MapPlace> start) {
  use_ = use;
  start_ = start;
  content_ = std::move(finished);
  content_.recordings.push_back(std::move(recording));
  content_.keyframes.settle_maps();
  for (const Keyframe& keyframe : content_.keyframes.all()) map_ = std::max(map_, keyframe.map + 1);
  begun_maps_ = map_ + 1;
  searched_ = content_.keyframes.size();
  last_fit_ = std::max(0, searched_ - 1);
  last_slip_search_ = searched_ - keyframes_between_fits;
}

/// Number of keyframes, from the first one, whose poses are held.
std::size_t RoomMapper::held_keyframes() const {
  if (use_ != MapUse::localise) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      content_.keyframes.all(),
      [&](const Keyframe& keyframe) { return keyframe.recording < recording(); }));
}

/// The registered frames of the recording that is being mapped: the last ones.
std::span<const RegisteredFrame> RoomMapper::own_frames() const {
  const auto first =
      std::ranges::lower_bound(content_.frames, recording(), {}, &RegisteredFrame::recording);
  return {first, content_.frames.end()};
}

AddedFrame RoomMapper::add_frame(const NewFrame& frame) {
  AddedFrame added;
  if (frame.repeats) {
    odometry_.note_frame(frame.timestamp_s);
    added.tracking.status = TrackingStatus::repeated;
    return added;
  }
  NewFrame still = frame;
  added.tracking = timed(added.register_ms, [&] { return track(still); });
  added.still = still.cloud;
  if (!added.tracking.registered()) {
    if (held_.size() < frames_until_lost) return added;
    added.late = timed(added.register_ms, [&] { return start_map(); });
    added.tracking = added.late.back().tracking;  // this frame was held last
    added.still = added.late.back().still;
    added.late.pop_back();
    if (!added.tracking.registered()) return added;
  } else {
    timed(added.integrate_ms, [&] { integrate(*still.cloud); });
  }
  const int map_before = map_;
  timed(added.loop_ms, [&] { close_loops(); });
  added.tracking.world_from_camera = pose_of(content_.frames.back(), content_.keyframes);
  if (map_ != map_before && is_joined()) added.tracking.status = TrackingStatus::relocalised;
  return added;
}

/// Finds the pose of a frame, takes what moves out of its cloud, and decides whether it becomes a
/// keyframe.
TrackingResult RoomMapper::track(NewFrame& frame) {
  // After some time the camera may be anywhere, and odometry may register it with a wrong place
  // that looks similar.
  std::vector<const Keyframe*> around;
  if (lost_frames_ < frames_until_given_up && !was_blind(frame.timestamp_s)) {
    around = keyframes_around();
  }
  const auto before = is_joined() ? std::optional(odometry_) : std::nullopt;
  NewFrame as_recorded = frame;
  StillTracking found = track_with(around, frame);
  if (found.tracking.registered() && before) {
    if (auto undisturbed = track_undisturbed(as_recorded, around, found, *before)) {
      found = *std::move(undisturbed);
      frame = std::move(as_recorded);
    }
  }
  TrackingResult result = std::move(found.tracking);
  if (!result.registered() && before) {
    odometry_ = *before;
    result = track_apart(frame, around);
  }
  odometry_.note_frame(frame.timestamp_s);
  if (!result.registered()) {
    if (!own_frames().empty()) ++lost_frames_;
    if (result.status != TrackingStatus::no_surface) held_.push_back(frame);
    return result;
  }
  lost_frames_ = 0;
  held_.clear();
  result.is_keyframe = wants_keyframe(result, around);
  if (result.is_keyframe) {
    add_keyframe(frame, around, result);
  } else if (const auto target = std::ranges::find_if(
                 result.targets, [&](int id) { return is_own(content_.keyframes[id]); });
             target != result.targets.end()) {
    current_ = *target;
  }
  const Pose keyframe_from_world = content_.keyframes[current_].world_from_camera.inverse();
  content_.frames.push_back({frame.timestamp_s, current_,
                             keyframe_from_world * result.world_from_camera, frame.index,
                             recording()});
  if (!result.is_keyframe) {
    const auto by_surfaces = covariance_of(information_of(result.registration));
    content_.frames.back().covariance =
        with_shared_errors(rotated(by_surfaces, keyframe_from_world.linear()));
  }
  content_.frames.back().constraints = std::exchange(result.constraints, {});
  result.target_covariances.clear();
  result.since_keyframe.reset();
  result.registration.target_information.clear();
  return result;
}

/// Registers a frame with keyframes, and takes what moves out of its cloud. Only keyframes of the
/// newest map tell what moves: differences from a map that was joined are evidence about the join.
StillTracking RoomMapper::track_with(std::span<const Keyframe* const> around, NewFrame& frame) {
  StillTracking found =
      odometry_.track(frame.timestamp_s, frame.cloud, around, own(around), content_.keyframes);
  frame.cloud = found.still;
  return found;
}

/// Those of the keyframes that were taken in the newest map, whatever it was joined with since.
std::vector<const Keyframe*> RoomMapper::own(std::span<const Keyframe* const> keyframes) const {
  std::vector<const Keyframe*> found;
  std::ranges::copy_if(keyframes, std::back_inserter(found),
                       [&](const Keyframe* keyframe) { return is_own(*keyframe); });
  return found;
}

KeyframeSpacing RoomMapper::keyframe_spacing() const {
  return {odometry_options_.keyframe_translation_m, odometry_options_.keyframe_rotation_rad};
}

std::vector<const Keyframe*> RoomMapper::keyframes_around() const {
  if (own_frames().empty() || content_.keyframes[content_.frames.back().keyframe].map != map_)
    return {};
  return content_.keyframes.around(content_.frames.back().keyframe,
                                   pose_of(content_.frames.back(), content_.keyframes),
                                   odometry_options_.keyframes_around, keyframe_spacing());
}

/// Adds the surface of the latest registered frame to the submap of its keyframe.
void RoomMapper::integrate(const SurfaceCloud& cloud) {
  Submap& submap = content_.submaps[static_cast<std::size_t>(
      content_.submap_of[static_cast<std::size_t>(current_)])];
  const Pose anchor_from_keyframe = content_.keyframes[submap.anchor].world_from_camera.inverse() *
                                    content_.keyframes[current_].world_from_camera;
  submap.surface.change().integrate(
      cloud, anchor_from_keyframe * content_.frames.back().keyframe_from_camera);
}

bool RoomMapper::wants_keyframe(const TrackingResult& result,
                                std::span<const Keyframe* const> around) const {
  const Pose& pose = result.world_from_camera;
  if (is_uncertain(result.spread, odometry_options_)) return true;
  // Behind a column or a person who moves, much may come into view without much motion.
  constexpr double least_overlap = 0.7;
  if (result.registration.overlap < least_overlap) return true;
  // Loops of keyframes that follow soon show whether the path, or the loop, is wrong.
  const double share = loop_awaits_others() ? share_for_loops : 1;
  return std::ranges::none_of(own(around), [&](const Keyframe* keyframe) {
    const bool is_of_earlier_visit = keyframe->id + recent_keyframes < content_.keyframes.size();
    return keyframe_spacing().between(keyframe->world_from_camera, pose) <
           share * (is_of_earlier_visit ? steps_on_earlier_visits : 1);
  });
}

void RoomMapper::add_keyframe(const NewFrame& frame, std::span<const Keyframe* const> around,
                              const TrackingResult& result) {
  const int id = content_.keyframes.size();
  double path_m = 0;
  if (id > 0) {
    const Keyframe& last = content_.keyframes[id - 1];
    path_m = last.path_m;
    if (last.map == map_) {
      path_m +=
          (result.world_from_camera.translation() - last.world_from_camera.translation()).norm();
    }
  }
  content_.submap_of.push_back(submap_for(id, result.world_from_camera, around));
  content_.keyframes.add({.id = id,
                          .frame_index = frame.index,
                          .timestamp_s = frame.timestamp_s,
                          .world_from_camera = result.world_from_camera,
                          .cloud = frame.cloud,
                          .path_m = path_m,
                          .place = PlaceDescriptor(*frame.cloud),
                          .map = map_,
                          .taken_in = newest_map(),
                          .recording = recording()});
  if (const auto& latest = result.since_keyframe) {
    content_.edges.push_back(edge_of(content_.keyframes[latest->keyframe], id,
                                     result.world_from_camera, latest->covariance));
  }
  for (std::size_t i = 0; i < result.targets.size(); ++i) {
    const int target = result.targets[i];
    if (!result.since_keyframe || target != result.since_keyframe->keyframe) {
      content_.edges.push_back(edge_of(content_.keyframes[target], id, result.world_from_camera,
                                       result.target_covariances[i]));
    }
    // Targets are well connected, and may constrain different directions.
    content_.keyframes.connect(target, id, result.spread);
  }
  odometry_.note_keyframe(id);
  current_ = id;
}

/// Index of the submap whose anchor is nearest to a new keyframe. If no anchor is near, a new
/// submap with the keyframe as its anchor.
int RoomMapper::submap_for(int id, const Pose& pose, std::span<const Keyframe* const> around) {
  int nearest = -1;
  double least_steps = submap_radius_steps;
  for (const Keyframe* keyframe : own(around)) {
    const int submap = content_.submap_of[static_cast<std::size_t>(keyframe->id)];
    const int anchor = content_.submaps[static_cast<std::size_t>(submap)].anchor;
    const double steps =
        keyframe_spacing().between(content_.keyframes[anchor].world_from_camera, pose);
    if (steps >= least_steps) continue;
    nearest = submap;
    least_steps = steps;
  }
  if (nearest >= 0) return nearest;
  content_.submaps.push_back({id, SurfaceMap(content_.surface_options)});
  return static_cast<int>(content_.submaps.size()) - 1;
}

}  // namespace tofmap
