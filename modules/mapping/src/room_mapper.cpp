// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/room_mapper.hpp"

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
      surface_options_(surface),
      odometry_(camera, odometry, registration, loops) {}

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
  added.tracking.world_from_camera = pose_of(frames_.back());
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
  TrackingResult result = track_with(around, frame);
  if (!result.registered() && before) {
    odometry_ = *before;
    result = track_apart(frame, around);
  }
  odometry_.note_frame(frame.timestamp_s);
  if (!result.registered()) {
    if (!frames_.empty()) ++lost_frames_;
    if (result.status != TrackingStatus::no_surface) held_.push_back(frame);
    return result;
  }
  lost_frames_ = 0;
  held_.clear();
  result.is_keyframe = wants_keyframe(result, around);
  if (result.is_keyframe) {
    add_keyframe(frame, around, result);
  } else if (const auto target = std::ranges::find_if(
                 result.targets, [&](int id) { return is_own(keyframes_[id]); });
             target != result.targets.end()) {
    current_ = *target;
  }
  frames_.push_back({frame.timestamp_s, current_,
                     keyframes_[current_].world_from_camera.inverse() * result.world_from_camera,
                     frame.index, result.spread.translation_sigma_m()});
  result.target_covariances.clear();
  result.registration.target_information.clear();
  return result;
}

/// Registers a frame with keyframes, and takes what moves out of its cloud. Only keyframes of the
/// newest map tell what moves: differences from a map that was joined are evidence about the join.
TrackingResult RoomMapper::track_with(std::span<const Keyframe* const> around, NewFrame& frame) {
  StillTracking found =
      odometry_.track(frame.timestamp_s, frame.cloud, around, own(around), keyframes_);
  frame.cloud = found.still;
  return std::move(found.tracking);
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
  if (frames_.empty() || keyframes_[frames_.back().keyframe].map != map_) return {};
  return keyframes_.around(frames_.back().keyframe, pose_of(frames_.back()),
                           odometry_options_.keyframes_around, keyframe_spacing());
}

Pose RoomMapper::pose_of(const RegisteredFrame& frame) const {
  return keyframes_[frame.keyframe].world_from_camera * frame.keyframe_from_camera;
}

/// Adds the surface of the latest registered frame to the submap of its keyframe.
void RoomMapper::integrate(const SurfaceCloud& cloud) {
  Submap& submap =
      submaps_[static_cast<std::size_t>(submap_of_[static_cast<std::size_t>(current_)])];
  const Pose anchor_from_keyframe = keyframes_[submap.anchor].world_from_camera.inverse() *
                                    keyframes_[current_].world_from_camera;
  submap.surface.integrate(cloud, anchor_from_keyframe * frames_.back().keyframe_from_camera);
}

Trajectory RoomMapper::trajectory(int map) const {
  Trajectory trajectory;
  for (const RegisteredFrame& frame : frames_) {
    if (keyframes_[frame.keyframe].map != map) continue;
    trajectory.push_back({frame.timestamp_s, pose_of(frame)});
  }
  return trajectory;
}

std::vector<int> RoomMapper::frames(int map) const {
  std::vector<int> indices;
  for (const RegisteredFrame& frame : frames_) {
    if (keyframes_[frame.keyframe].map == map) indices.push_back(frame.index);
  }
  return indices;
}

Trajectory RoomMapper::keyframe_trajectory(int map) const {
  Trajectory trajectory;
  for (const Keyframe& keyframe : keyframes_.all()) {
    if (keyframe.map != map) continue;
    trajectory.push_back({keyframe.timestamp_s, keyframe.world_from_camera});
  }
  return trajectory;
}

PoseCertainty RoomMapper::least_certain(int map) const {
  std::vector<Pose> poses;
  std::vector<int> index_of(static_cast<std::size_t>(keyframes_.size()), -1);
  for (const Keyframe& keyframe : keyframes_.all()) {
    if (keyframe.map != map) continue;
    index_of[static_cast<std::size_t>(keyframe.id)] = static_cast<int>(poses.size());
    poses.push_back(keyframe.world_from_camera);
  }
  std::vector<PoseEdge> edges;
  auto loop = loops_.begin();
  for (const PoseEdge& edge : edges_) {
    const bool is_used = !edge.may_be_wrong || loop++->is_used;
    if (!is_used || keyframes_[edge.from].map != map || keyframes_[edge.to].map != map) continue;
    edges.push_back(edge);
    edges.back().from = index_of[static_cast<std::size_t>(edge.from)];
    edges.back().to = index_of[static_cast<std::size_t>(edge.to)];
  }
  const std::vector<ExpectedError> errors = expected_errors(poses, edges);
  PoseCertainty least{.frame = -1, .error = {}};
  for (const RegisteredFrame& frame : frames_) {
    if (keyframes_[frame.keyframe].map != map) continue;
    const int index = index_of[static_cast<std::size_t>(frame.keyframe)];
    ExpectedError error = errors[static_cast<std::size_t>(index)];
    error.position_m = std::hypot(error.position_m, frame.sigma_m);
    if (least.frame < 0 || error.position_m > least.error.position_m) least = {frame.index, error};
  }
  return least;
}

std::size_t RoomMapper::voxel_count() const {
  std::size_t count = 0;
  for (const Submap& submap : submaps_) count += submap.surface.size();
  return count;
}

MapCloud RoomMapper::surface(int map) const {
  SurfaceMap whole(surface_options_);
  for (const Submap& submap : submaps_) {
    const Keyframe& anchor = keyframes_[submap.anchor];
    if (anchor.map == map) whole.add(submap.surface, anchor.world_from_camera);
  }
  MapCloud surface = whole.extract();
  if (!surface_options_.drop_free_space_violations) return surface;
  std::vector<Keyframe> seen_by;
  std::ranges::copy_if(keyframes_.all(), std::back_inserter(seen_by),
                       [&](const Keyframe& keyframe) { return keyframe.map == map; });
  return without_free_space_violations(surface, seen_by, camera_, surface_options_.voxel_m);
}

bool RoomMapper::wants_keyframe(const TrackingResult& result,
                                std::span<const Keyframe* const> around) const {
  const Pose& pose = result.world_from_camera;
  // Between keyframes that see more, the path is corrected only at keyframes.
  constexpr double most_share = 0.2;
  if (result.spread.translation_sigma_m() > most_share * odometry_options_.keyframe_translation_m) {
    return true;
  }
  // Behind a column or a person who moves, much may come into view without much motion.
  constexpr double least_overlap = 0.7;
  if (result.registration.overlap < least_overlap) return true;
  // Loops of keyframes that follow soon show whether the path, or the loop, is wrong.
  const double share = loop_awaits_others() ? share_for_loops : 1;
  return std::ranges::none_of(own(around), [&](const Keyframe* keyframe) {
    const bool is_of_earlier_visit = keyframe->id + recent_keyframes < keyframes_.size();
    return keyframe_spacing().between(keyframe->world_from_camera, pose) <
           share * (is_of_earlier_visit ? steps_on_earlier_visits : 1);
  });
}

void RoomMapper::add_keyframe(const NewFrame& frame, std::span<const Keyframe* const> around,
                              const TrackingResult& result) {
  const int id = keyframes_.size();
  double path_m = 0;
  if (id > 0) {
    const Keyframe& last = keyframes_[id - 1];
    path_m = last.path_m;
    if (last.map == map_) {
      path_m +=
          (result.world_from_camera.translation() - last.world_from_camera.translation()).norm();
    }
  }
  submap_of_.push_back(submap_for(id, result.world_from_camera, around));
  keyframes_.add({id, frame.index, frame.timestamp_s, result.world_from_camera, frame.cloud, path_m,
                  PlaceDescriptor(*frame.cloud), map_, newest_map()});
  for (std::size_t i = 0; i < result.targets.size(); ++i) {
    const int target = result.targets[i];
    edges_.push_back(
        edge_of(keyframes_[target], id, result.world_from_camera, result.target_covariances[i]));
    // Targets are well connected, and may constrain different directions.
    keyframes_.connect(target, id, result.spread);
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
    const int submap = submap_of_[static_cast<std::size_t>(keyframe->id)];
    const int anchor = submaps_[static_cast<std::size_t>(submap)].anchor;
    const double steps = keyframe_spacing().between(keyframes_[anchor].world_from_camera, pose);
    if (steps >= least_steps) continue;
    nearest = submap;
    least_steps = steps;
  }
  if (nearest >= 0) return nearest;
  submaps_.push_back({id, SurfaceMap(surface_options_)});
  return static_cast<int>(submaps_.size()) - 1;
}

}  // namespace tofmap
