// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/room_mapper.hpp"

#include "tofmap/mapping/seen_through.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// Loops are mostly found in a row: they are fitted together, once in so many keyframes.
constexpr int keyframes_between_fits = 10;

/// One frame that fails may be a bad one.
constexpr int frames_until_lost = 3;

/// After so many frames motion does not tell any more where the camera may be.
constexpr int frames_until_given_up = 15;

/// On each side of the keyframe that a lost camera is found by.
constexpr int keyframes_around = 7;

}  // namespace

RoomMapper::RoomMapper(const CameraModel& camera, const OdometryOptions& odometry,
                       const RegistrationOptions& registration, const LoopOptions& loops,
                       const SurfaceMapOptions& surface)
    : camera_(camera),
      registration_(registration),
      loop_options_(loops),
      surface_options_(surface),
      odometry_(camera, odometry, registration) {}

TrackingResult RoomMapper::track(int frame_index, double timestamp_s,
                                 const std::shared_ptr<const SurfaceCloud>& cloud) {
  const TrackingResult result = find_camera(frame_index, timestamp_s, cloud);
  if (!frames_.empty()) lost_frames_ = result.placed() ? 0 : lost_frames_ + 1;
  if (!result.placed()) return result;
  if (result.is_keyframe) add_keyframe(result);
  const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(current_)];
  frames_.push_back(
      {timestamp_s, keyframe.id, keyframe.world_from_camera.inverse() * result.world_from_camera});
  return result;
}

TrackingResult RoomMapper::find_camera(int frame_index, double timestamp_s,
                                       const std::shared_ptr<const SurfaceCloud>& cloud) {
  // A camera that has been lost for some time may be anywhere, and many places look alike from near
  // where it was last seen: so all of them are looked at first.
  if (lost_frames_ >= frames_until_lost) {
    const TrackingResult found = relocalised(timestamp_s, *cloud);
    if (found.placed() || lost_frames_ >= frames_until_given_up) return found;
  }
  return odometry_.track(frame_index, timestamp_s, cloud);
}

TrackingResult RoomMapper::relocalised(double timestamp_s, const SurfaceCloud& cloud) {
  TrackingResult result;
  const auto found =
      relocalise(cloud, keyframes_, descriptors_, camera_, loop_options_, registration_);
  if (!found) return result;
  result.status = TrackingStatus::relocalised;
  result.world_from_camera = found->registration.world_from_camera;
  result.registration = found->registration;
  current_ = found->keyframe;
  // Those around it in time; it comes last.
  std::vector<Keyframe> around;
  const int last = std::min(static_cast<int>(keyframes_.size()) - 1, current_ + keyframes_around);
  for (int id = std::max(0, current_ - keyframes_around); id <= last; ++id) {
    if (id != current_) around.push_back(keyframes_[static_cast<std::size_t>(id)]);
  }
  around.push_back(keyframes_[static_cast<std::size_t>(current_)]);
  odometry_.restart({timestamp_s, result.world_from_camera}, around);
  return result;
}

void RoomMapper::integrate(const SurfaceCloud& cloud) {
  if (frames_.empty()) return;
  parts_[static_cast<std::size_t>(current_)].integrate(cloud, frames_.back().keyframe_from_camera);
}

void RoomMapper::close_loops() {
  if (!loop_options_.close || searched_ == static_cast<int>(keyframes_.size())) return;
  searched_ = static_cast<int>(keyframes_.size());
  const Keyframe& keyframe = keyframes_.back();
  const LoopCandidate candidate =
      find_loop(keyframe, keyframes_, path_m_, camera_, loop_options_, registration_);
  if (candidate.edge) {
    edges_.push_back(*candidate.edge);
    const Pose& found = candidate.registration.world_from_camera;
    loops_.push_back(
        {.from_frame = keyframes_[static_cast<std::size_t>(candidate.from)].frame_index,
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
  for (const PlacedFrame& frame : frames_) {
    const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(frame.keyframe)];
    trajectory.push_back(
        {frame.timestamp_s, keyframe.world_from_camera * frame.keyframe_from_camera});
  }
  return trajectory;
}

Trajectory RoomMapper::keyframe_trajectory() const {
  Trajectory trajectory;
  for (const Keyframe& keyframe : keyframes_) {
    trajectory.push_back({keyframe.timestamp_s, keyframe.world_from_camera});
  }
  return trajectory;
}

MapCloud RoomMapper::surface() const {
  SurfaceMap whole(surface_options_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    whole.add(parts_[i], keyframes_[i].world_from_camera);
  }
  const MapCloud map = whole.extract();
  if (!surface_options_.drop_seen_through) return map;
  return without_seen_through(map, keyframes_, camera_, surface_options_.voxel_m);
}

void RoomMapper::add_keyframe(const TrackingResult& result) {
  const Keyframe& keyframe = odometry_.recent_keyframes().back();
  double path_m = 0;
  if (!keyframes_.empty()) {
    const Pose& last = keyframes_.back().world_from_camera;
    path_m =
        path_m_.back() + (keyframe.world_from_camera.translation() - last.translation()).norm();
  }
  // Targets are registered against together: each edge says its share of what all of them say.
  const auto shares = static_cast<double>(result.targets.size());
  for (const int target : result.targets) {
    PoseEdge edge =
        edge_of(keyframes_[static_cast<std::size_t>(target)], keyframe.id, result.registration);
    edge.covariance *= shares;
    edges_.push_back(edge);
  }
  current_ = keyframe.id;
  keyframes_.push_back(keyframe);
  descriptors_.emplace_back(*keyframe.cloud);
  path_m_.push_back(path_m);
  parts_.emplace_back(surface_options_);
}

void RoomMapper::fit() {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : keyframes_) poses.push_back(keyframe.world_from_camera);
  const PoseGraphResult fitted =
      optimise_pose_graph(std::move(poses), edges_, loop_options_.kernel_width);
  for (Keyframe& keyframe : keyframes_) {
    keyframe.world_from_camera = fitted.poses[static_cast<std::size_t>(keyframe.id)];
  }
  odometry_.correct(fitted.poses);
  auto loop = loops_.begin();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (!edges_[i].may_be_wrong) continue;
    loop->deviations = fitted.edge_deviations[i];
    // Geman and McClure's weight is a sixteenth there.
    loop->is_used = loop->deviations < std::sqrt(3) * loop_options_.kernel_width;
    ++loop;
  }
  unfitted_loops_ = 0;
  last_fit_ = keyframes_.back().id;
}

}  // namespace tofmap
