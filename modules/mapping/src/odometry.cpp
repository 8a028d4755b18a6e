// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/odometry.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

bool has_surface(const SurfaceCloud& cloud, int min_points) {
  int count = 0;
  for (const SurfacePoint& point : cloud.points) {
    if (point.has_normal() && ++count >= min_points) return true;
  }
  return false;
}

/// How many standard deviations of the prior the pose is off, the worse of both parts.
double deviation(const MotionPrior& prior, const Pose& pose) {
  const double turn = rotation_angle_rad(prior.world_from_camera, pose);
  const double step = (prior.world_from_camera.translation() - pose.translation()).norm();
  return std::max(turn / prior.rotation_sigma_rad, step / prior.translation_sigma_m);
}

}  // namespace

std::vector<OptionField<OdometryOptions>> OdometryOptions::fields() {
  using O = OdometryOptions;
  return {
      {"keyframe_step_m", &O::keyframe_step_m, 0.01, 10, "m",
       "a frame this far from all recent keyframes becomes one"},
      {"keyframe_turn_rad", &O::keyframe_turn_rad, 0.01, 3.2, "rad",
       "a frame turned this far from all recent keyframes becomes one"},
      {"recent_keyframes", &O::recent_keyframes, 1, 1000, "",
       "how many keyframes are kept to register against"},
      {"targets", &O::targets, 1, 16, "", "how many of them, those that overlap most, are used"},
      {"min_target_overlap", &O::min_target_overlap, 0, 1, "",
       "share of the frame a keyframe must see to be used"},
      {"prior_rotation_sigma_rad", &O::prior_rotation_sigma_rad, 1e-4, 3.2, "rad",
       "how much the turn between two frames may change from one to the next"},
      {"prior_translation_sigma_m", &O::prior_translation_sigma_m, 1e-4, 10, "m",
       "how much the step between two frames may change from one to the next"},
      {"max_prior_deviation", &O::max_prior_deviation, 1, 1000, "",
       "a pose more of these standard deviations off the expected one is not believed"},
  };
}

const char* status_name(TrackingStatus status) {
  switch (status) {
    case TrackingStatus::first:
      return "first";
    case TrackingStatus::tracked:
      return "tracked";
    case TrackingStatus::no_surface:
      return "no_surface";
    case TrackingStatus::lost:
      return "lost";
    case TrackingStatus::implausible:
      return "implausible";
    case TrackingStatus::relocalised:
      return "relocalised";
  }
  return "unknown";
}

Odometry::Odometry(const CameraModel& camera, const OdometryOptions& options,
                   const RegistrationOptions& registration)
    : camera_(camera), options_(options), registration_(registration) {}

TrackingResult Odometry::track(int frame_index, double timestamp_s,
                               const std::shared_ptr<const SurfaceCloud>& cloud) {
  TrackingResult result;
  ++frames_since_placed_;
  if (!has_surface(*cloud, registration_.min_correspondences)) {
    result.status = TrackingStatus::no_surface;
    return result;
  }
  if (!last_) {
    result.status = TrackingStatus::first;
    accept(frame_index, timestamp_s, cloud, result);
    return result;
  }
  const MotionPrior prior = predict(timestamp_s);
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* keyframe : choose_targets(*cloud, prior.world_from_camera)) {
    targets.push_back({keyframe->cloud.get(), keyframe->world_from_camera});
    result.targets.push_back(keyframe->id);
  }
  result.registration = register_to_targets(*cloud, targets, camera_, prior, registration_);
  if (!succeeded(result.registration.status)) {
    result.status = TrackingStatus::lost;
  } else if (deviation(prior, result.registration.world_from_camera) >
             options_.max_prior_deviation) {
    result.status = TrackingStatus::implausible;
  } else {
    result.status = TrackingStatus::tracked;
    result.world_from_camera = result.registration.world_from_camera;
    accept(frame_index, timestamp_s, cloud, result);
  }
  return result;
}

MotionPrior Odometry::predict(double timestamp_s) const {
  MotionPrior prior;
  // Every frame that could not be placed adds its share of unknown motion.
  prior.rotation_sigma_rad = frames_since_placed_ * options_.prior_rotation_sigma_rad;
  prior.translation_sigma_m = frames_since_placed_ * options_.prior_translation_sigma_m;
  prior.world_from_camera = last_->world_from_camera;
  const double last_step_s = before_last_ ? last_->timestamp_s - before_last_->timestamp_s : 0;
  // After a gap the old velocity says little: a camera that is lost is expected to stay.
  constexpr int frames_of_steady_motion = 3;
  if (last_step_s > 0 && frames_since_placed_ <= frames_of_steady_motion) {
    const double share = 1 + (timestamp_s - last_->timestamp_s) / last_step_s;
    prior.world_from_camera =
        interpolate(before_last_->world_from_camera, last_->world_from_camera, share);
  }
  return prior;
}

std::vector<const Keyframe*> Odometry::choose_targets(const SurfaceCloud& cloud,
                                                      const Pose& expected) const {
  struct Candidate {
    double overlap;
    const Keyframe* keyframe;
  };
  std::vector<Candidate> candidates;
  for (const Keyframe& keyframe : keyframes_) {
    const RegistrationTarget target{keyframe.cloud.get(), keyframe.world_from_camera};
    const double overlap = overlap_share(cloud, expected, target, camera_, registration_);
    // The newest is taken at any rate: a frame may overlap nothing else.
    const bool is_newest = &keyframe == &keyframes_.back();
    if (overlap >= options_.min_target_overlap || is_newest)
      candidates.push_back({overlap, &keyframe});
  }
  // Stable from the newest on, so that equal overlap prefers the recent.
  std::ranges::reverse(candidates);
  std::ranges::stable_sort(candidates, std::ranges::greater(), &Candidate::overlap);
  std::vector<const Keyframe*> targets;
  for (const Candidate& candidate : candidates) {
    if (static_cast<int>(targets.size()) == options_.targets) break;
    targets.push_back(candidate.keyframe);
  }
  return targets;
}

void Odometry::restart(const StampedPose& pose, std::span<const Keyframe> keyframes) {
  keyframes_.assign(keyframes.begin(), keyframes.end());
  last_ = pose;
  before_last_.reset();
  frames_since_placed_ = 0;
}

void Odometry::correct(std::span<const Pose> world_from_keyframe) {
  if (keyframes_.empty()) return;
  const Pose before = keyframes_.back().world_from_camera;
  for (Keyframe& keyframe : keyframes_) {
    keyframe.world_from_camera = world_from_keyframe[static_cast<std::size_t>(keyframe.id)];
  }
  const Pose change = keyframes_.back().world_from_camera * before.inverse();
  for (std::optional<StampedPose>* pose : {&last_, &before_last_}) {
    if (*pose) (*pose)->world_from_camera = change * (*pose)->world_from_camera;
  }
}

bool Odometry::wants_keyframe(const Pose& pose) const {
  return std::ranges::none_of(keyframes_, [&](const Keyframe& keyframe) {
    const Pose& other = keyframe.world_from_camera;
    return (pose.translation() - other.translation()).norm() < options_.keyframe_step_m &&
           rotation_angle_rad(pose, other) < options_.keyframe_turn_rad;
  });
}

void Odometry::accept(int frame_index, double timestamp_s,
                      const std::shared_ptr<const SurfaceCloud>& cloud, TrackingResult& result) {
  before_last_ = last_;
  last_ = StampedPose{timestamp_s, result.world_from_camera};
  frames_since_placed_ = 0;
  if (!wants_keyframe(result.world_from_camera)) return;
  result.is_keyframe = true;
  keyframes_.push_back(
      {keyframe_count_++, frame_index, timestamp_s, result.world_from_camera, cloud});
  if (static_cast<int>(keyframes_.size()) > options_.recent_keyframes) keyframes_.pop_front();
}

}  // namespace tofmap
