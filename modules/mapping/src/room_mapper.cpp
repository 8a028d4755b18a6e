// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/room_mapper.hpp"

#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/loop_fit.hpp"

#include <algorithm>

#include <tofmap/core/timed.hpp>

namespace tofmap {
namespace {

/// Smallest number of keyframes between two fits. Loops mostly come one after the other, and are
/// fitted together.
constexpr int keyframes_between_fits = 10;

/// Number of failed frames after which tracking is taken to be lost. A single one may be a bad
/// frame.
constexpr int frames_until_lost = 3;

/// Number of failed frames after which the motion before no longer predicts the camera's pose.
constexpr int frames_until_given_up = 15;

/// A keyframe with more than this many newer ones belongs to an earlier visit. New keyframes are
/// taken at twice the distance there.
constexpr int recent_keyframes = 15;
constexpr double steps_on_earlier_visits = 2;

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
  added.tracking = timed(added.register_ms, [&] { return track(frame); });
  if (!added.tracking.registered()) return added;
  timed(added.integrate_ms, [&] { integrate(*frame.cloud); });
  timed(added.loop_ms, [&] { close_loops(); });
  return added;
}

/// Finds the pose of a frame, and decides whether it becomes a keyframe.
TrackingResult RoomMapper::track(const NewFrame& frame) {
  const std::vector<const Keyframe*> around = keyframes_around();
  TrackingResult result = find_camera(frame.timestamp_s, *frame.cloud, around);
  odometry_.note_frame(frame.timestamp_s);
  if (!frames_.empty()) lost_frames_ = result.registered() ? 0 : lost_frames_ + 1;
  if (!result.registered()) return result;
  result.is_keyframe = result.status != TrackingStatus::relocalised &&
                       wants_keyframe(result.world_from_camera, around);
  if (result.is_keyframe) {
    add_keyframe(frame, around, result);
  } else if (!result.targets.empty()) {
    current_ = result.targets.front();
  }
  frames_.push_back({frame.timestamp_s, current_,
                     keyframes_[current_].world_from_camera.inverse() * result.world_from_camera});
  return result;
}

KeyframeSpacing RoomMapper::keyframe_spacing() const {
  return {odometry_options_.keyframe_translation_m, odometry_options_.keyframe_rotation_rad};
}

std::vector<const Keyframe*> RoomMapper::keyframes_around() const {
  if (frames_.empty()) return {};
  const RegisteredFrame& last = frames_.back();
  const Pose pose = keyframes_[last.keyframe].world_from_camera * last.keyframe_from_camera;
  return keyframes_.around(last.keyframe, pose, odometry_options_.keyframes_around,
                           keyframe_spacing());
}

TrackingResult RoomMapper::find_camera(double timestamp_s, const SurfaceCloud& cloud,
                                       std::span<const Keyframe* const> around) {
  // After some time the camera may be anywhere, and odometry may register it with a wrong place
  // that looks similar. So all keyframes are tried first.
  if (lost_frames_ >= frames_until_lost) {
    const TrackingResult found = relocalised(timestamp_s, cloud);
    if (found.registered() || lost_frames_ >= frames_until_given_up) return found;
  }
  return odometry_.track(timestamp_s, cloud, around);
}

TrackingResult RoomMapper::relocalised(double timestamp_s, const SurfaceCloud& cloud) {
  TrackingResult result;
  const auto found = relocalise(cloud, keyframes_.all(), camera_, loop_options_, registration_);
  if (!found) return result;
  // Many places look alike: a place that the camera can hardly have reached must match better.
  constexpr double sure_support = 0.85;
  constexpr double sure_support_within_reach = 0.6;
  const RegistrationResult& there = found->registration;
  const bool is_within_reach = odometry_.is_within_reach(timestamp_s, there.world_from_camera);
  if (there.overlap * there.inlier_ratio <
      (is_within_reach ? sure_support_within_reach : sure_support)) {
    return result;
  }
  result.status = TrackingStatus::relocalised;
  result.world_from_camera = found->registration.world_from_camera;
  result.registration = found->registration;
  result.targets = {found->keyframe};
  odometry_.restart({timestamp_s, result.world_from_camera});
  return result;
}

/// Adds the surface of the latest registered frame to the submap of its keyframe.
void RoomMapper::integrate(const SurfaceCloud& cloud) {
  Submap& submap =
      submaps_[static_cast<std::size_t>(submap_of_[static_cast<std::size_t>(current_)])];
  const Pose anchor_from_keyframe = keyframes_[submap.anchor].world_from_camera.inverse() *
                                    keyframes_[current_].world_from_camera;
  submap.surface.integrate(cloud, anchor_from_keyframe * frames_.back().keyframe_from_camera);
}

/// Searches for a loop of the newest keyframe, once per keyframe, and fits the pose graph if there
/// are new loops and the last fit was long enough ago.
void RoomMapper::close_loops() {
  if (!loop_options_.close || searched_ == keyframes_.size()) return;
  searched_ = keyframes_.size();
  const Keyframe& keyframe = keyframes_[keyframes_.size() - 1];
  const LoopCandidate candidate =
      find_loop(keyframe, keyframes_.all(), camera_, loop_options_, registration_);
  if (candidate.edge) {
    edges_.push_back(*candidate.edge);
    const Pose& found = candidate.registration.world_from_camera;
    loops_.push_back(
        {.from_frame = keyframes_[candidate.from].frame_index,
         .to_frame = keyframe.frame_index,
         .error_m = (found.translation() - keyframe.world_from_camera.translation()).norm()});
    ++unfitted_loops_;
  }
  if (unfitted_loops_ > 0 && keyframe.id - last_fit_ >= keyframes_between_fits) fit();
}

void RoomMapper::finish() {
  if (unfitted_loops_ > 0) fit();
}

Trajectory RoomMapper::trajectory() const {
  Trajectory trajectory;
  for (const RegisteredFrame& frame : frames_) {
    const Pose& world_from_keyframe = keyframes_[frame.keyframe].world_from_camera;
    trajectory.push_back({frame.timestamp_s, world_from_keyframe * frame.keyframe_from_camera});
  }
  return trajectory;
}

Trajectory RoomMapper::keyframe_trajectory() const {
  Trajectory trajectory;
  for (const Keyframe& keyframe : keyframes_.all()) {
    trajectory.push_back({keyframe.timestamp_s, keyframe.world_from_camera});
  }
  return trajectory;
}

std::size_t RoomMapper::voxel_count() const {
  std::size_t count = 0;
  for (const Submap& submap : submaps_) count += submap.surface.size();
  return count;
}

MapCloud RoomMapper::surface() const {
  SurfaceMap whole(surface_options_);
  for (const Submap& submap : submaps_) {
    whole.add(submap.surface, keyframes_[submap.anchor].world_from_camera);
  }
  const MapCloud map = whole.extract();
  if (!surface_options_.drop_free_space_violations) return map;
  return without_free_space_violations(map, keyframes_.all(), camera_, surface_options_.voxel_m);
}

bool RoomMapper::wants_keyframe(const Pose& pose, std::span<const Keyframe* const> around) const {
  return std::ranges::none_of(around, [&](const Keyframe* keyframe) {
    const bool is_of_earlier_visit = keyframe->id + recent_keyframes < keyframes_.size();
    return keyframe_spacing().between(keyframe->world_from_camera, pose) <
           (is_of_earlier_visit ? steps_on_earlier_visits : 1);
  });
}

void RoomMapper::add_keyframe(const NewFrame& frame, std::span<const Keyframe* const> around,
                              const TrackingResult& result) {
  const int id = keyframes_.size();
  double path_m = 0;
  if (id > 0) {
    const Pose& last = keyframes_[id - 1].world_from_camera;
    path_m = keyframes_[id - 1].path_m +
             (result.world_from_camera.translation() - last.translation()).norm();
  }
  submap_of_.push_back(submap_for(id, result.world_from_camera, around));
  keyframes_.add({id, frame.index, frame.timestamp_s, result.world_from_camera, frame.cloud, path_m,
                  PlaceDescriptor(*frame.cloud)});
  // One registration with all targets gives several edges, each with an equal share of its
  // information.
  const auto shares = static_cast<double>(result.targets.size());
  for (const int target : result.targets) {
    PoseEdge edge =
        edge_of(keyframes_[target], id, result.world_from_camera, result.pose_covariance);
    edge.covariance *= shares;
    edges_.push_back(edge);
    keyframes_.connect(target, id);
  }
  current_ = id;
}

/// Index of the submap whose anchor is nearest to a new keyframe. If no anchor is near, a new
/// submap with the keyframe as its anchor.
int RoomMapper::submap_for(int id, const Pose& pose, std::span<const Keyframe* const> around) {
  int nearest = -1;
  double least_steps = submap_radius_steps;
  for (const Keyframe* keyframe : around) {
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

void RoomMapper::fit() {
  const Pose current_before = keyframes_[current_].world_from_camera;
  const PoseGraphResult fitted = fit_loops(keyframes_.all(), edges_, loop_options_);
  for (int id = 0; id < keyframes_.size(); ++id) {
    keyframes_.set_pose(id, fitted.poses[static_cast<std::size_t>(id)]);
  }
  odometry_.move(keyframes_[current_].world_from_camera * current_before.inverse());
  auto loop = loops_.begin();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (!edges_[i].may_be_wrong) continue;
    loop->mahalanobis_distance = fitted.edge_mahalanobis[i];
    loop->is_used = !is_rejected(loop->mahalanobis_distance, loop_options_.kernel_width);
    // The relative pose of both ends is now correct, so frames may be registered with either.
    if (loop->is_used) keyframes_.connect(edges_[i].from, edges_[i].to);
    ++loop;
  }
  unfitted_loops_ = 0;
  last_fit_ = keyframes_.size() - 1;
}

}  // namespace tofmap
