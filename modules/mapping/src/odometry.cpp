// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/odometry.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// One that has not been registered for longer may have moved otherwise than before.
constexpr double periods_of_steady_tracking = 3.5;

/// Share of the frame's points that agree with the targets; 0 if registration failed.
double support(const RegistrationResult& result) {
  return succeeded(result.status) ? result.overlap * result.inlier_ratio : 0;
}

bool has_surface(const SurfaceCloud& cloud, int min_points) {
  int count = 0;
  for (const SurfacePoint& point : cloud.points) {
    if (point.has_normal() && ++count >= min_points) return true;
  }
  return false;
}

}  // namespace

std::vector<OptionField<OdometryOptions>> OdometryOptions::fields() {
  using O = OdometryOptions;
  return {
      {"keyframe_translation_m", &O::keyframe_translation_m, 0.01, 10, "m",
       "a frame this far from all keyframes around becomes one; twice as far from those of an "
       "earlier visit"},
      {"keyframe_rotation_rad", &O::keyframe_rotation_rad, 0.01, 3.2, "rad",
       "a frame turned this far from all keyframes around becomes one; twice as far from those of "
       "an earlier visit"},
      {"keyframes_around", &O::keyframes_around, 1, 1000, "",
       "how many keyframes are looked at to register against"},
      {"targets", &O::targets, 1, 16, "", "how many of them, those that overlap most, are used"},
      {"min_target_overlap", &O::min_target_overlap, 0, 1, "",
       "share of the frame a keyframe must see to be used"},
      {"prior_rotation_sigma_rad", &O::prior_rotation_sigma_rad, 1e-4, 3.2, "rad",
       "how much the turn between two frames may change from one to the next"},
      {"prior_translation_sigma_m", &O::prior_translation_sigma_m, 1e-4, 10, "m",
       "how much the step between two frames may change from one to the next"},
      {"max_prior_mahalanobis", &O::max_prior_mahalanobis, 1, 1000, "",
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
    case TrackingStatus::repeated:
      return "repeated";
  }
  return "unknown";
}

Odometry::Odometry(const CameraModel& camera, const OdometryOptions& options,
                   const RegistrationOptions& registration)
    : camera_(camera),
      options_(options),
      registration_(registration),
      uncertainty_(options.prior_rotation_sigma_rad, options.prior_translation_sigma_m) {}

TrackingResult Odometry::track(double timestamp_s, const SurfaceCloud& cloud,
                               std::span<const Keyframe* const> around,
                               const std::function<bool(const RegistrationResult&)>& is_believed) {
  TrackingResult result;
  ++frames_since_registered_;
  if (!has_surface(cloud, registration_.min_correspondences)) {
    result.status = TrackingStatus::no_surface;
    return result;
  }
  if (!last_) {
    result.status = TrackingStatus::first;
    accept({timestamp_s, result.world_from_camera});
    return result;
  }
  MotionPrior prior = predict(timestamp_s);
  register_from(prior, cloud, around, result);
  MotionPrior standing = prior;
  standing.world_from_camera = last_->world_from_camera;
  if (is_after_gap(timestamp_s) && deviation(prior, standing.world_from_camera) > 0) {
    // It may as well have stood still.
    TrackingResult other;
    register_from(standing, cloud, around, other);
    if (support(other.registration) > support(result.registration)) {
      result = other;
      prior = standing;
    }
  }
  if (!succeeded(result.registration.status)) {
    result.status = TrackingStatus::lost;
  } else if (is_believed && !is_believed(result.registration)) {
    result.status = TrackingStatus::lost;
  } else if (deviation(prior, result.registration.world_from_camera) >
             options_.max_prior_mahalanobis) {
    result.status = TrackingStatus::implausible;
  } else {
    result.status = TrackingStatus::tracked;
    result.world_from_camera = result.registration.world_from_camera;
    // The prior of one frame does not tell of those before it that left a direction open, too.
    const double periods = std::max(1.0, periods_since_registered(timestamp_s));
    uncertainty_.learn(static_cast<int>(std::lround(periods)),
                       result.registration.surface_information);
    result.pose_covariance = uncertainty_.of_pose();
    accept({timestamp_s, result.world_from_camera});
  }
  return result;
}

void Odometry::register_from(const MotionPrior& prior, const SurfaceCloud& cloud,
                             std::span<const Keyframe* const> around,
                             TrackingResult& result) const {
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* keyframe : choose_targets(cloud, prior.world_from_camera, around)) {
    targets.push_back(target_of(*keyframe));
    result.targets.push_back(keyframe->id);
  }
  RegistrationOptions registration = registration_;
  // From far off more steps are needed.
  constexpr int times = 3;
  if (prior.translation_sigma_m > periods_of_steady_tracking * options_.prior_translation_sigma_m) {
    registration.max_iterations *= times;
  }
  result.registration = register_to_targets(cloud, targets, camera_, prior, registration);
}

bool Odometry::is_after_gap(double timestamp_s) const {
  return periods_since_registered(timestamp_s) > periods_of_steady_tracking;
}

bool Odometry::is_within_reach(double timestamp_s, const Pose& pose) const {
  constexpr double most_sigmas = 4;
  if (!last_) return false;
  MotionPrior prior = predict(timestamp_s);
  if (deviation(prior, pose) <= most_sigmas) return true;
  prior.world_from_camera = last_->world_from_camera;
  return deviation(prior, pose) <= most_sigmas;
}

void Odometry::note_frame(double timestamp_s) {
  constexpr std::size_t enough = 15;
  if (last_ && timestamp_s > last_timestamp_s_) {
    recent_periods_s_.push_back(timestamp_s - last_timestamp_s_);
    if (recent_periods_s_.size() > enough) recent_periods_s_.erase(recent_periods_s_.begin());
  }
  last_timestamp_s_ = timestamp_s;
}

double Odometry::periods_since_registered(double timestamp_s) const {
  if (!last_) return 0;
  double periods = frames_since_registered_;
  if (!recent_periods_s_.empty()) {
    // Of frames that are dropped now and then most still come one after the other.
    std::vector<double> periods_s = recent_periods_s_;
    const auto usual = periods_s.begin() + static_cast<std::ptrdiff_t>((periods_s.size() - 1) / 2);
    std::ranges::nth_element(periods_s, usual);
    periods = std::max(periods, (timestamp_s - last_->timestamp_s) / *usual);
  }
  constexpr double for_ever = 1000;
  return std::min(periods, for_ever);
}

MotionPrior Odometry::predict(double timestamp_s) const {
  MotionPrior prior;
  // Every frame that could not be registered, or never came, adds its share of unknown motion.
  const double periods = std::max(1.0, periods_since_registered(timestamp_s));
  prior.rotation_sigma_rad = periods * options_.prior_rotation_sigma_rad;
  prior.translation_sigma_m = periods * options_.prior_translation_sigma_m;
  prior.world_from_camera = last_->world_from_camera;
  // Frames that were there and could not be registered are a sign that motion has changed. Where
  // none came it is the best guess, for some time.
  constexpr int frames_of_steady_motion = 3;
  constexpr double most_periods = 30;
  const double last_step_s = before_last_ ? last_->timestamp_s - before_last_->timestamp_s : 0;
  if (last_step_s > 0 && frames_since_registered_ <= frames_of_steady_motion) {
    const double share = (timestamp_s - last_->timestamp_s) / last_step_s;
    const Pose step = before_last_->world_from_camera.inverse() * last_->world_from_camera;
    // A camera that turns goes on along its own axes, not along the world's.
    prior.world_from_camera = last_->world_from_camera *
                              interpolate(Pose::Identity(), step, std::min(share, most_periods));
  }
  return prior;
}

std::vector<const Keyframe*> Odometry::choose_targets(
    const SurfaceCloud& cloud, const Pose& expected,
    std::span<const Keyframe* const> around) const {
  struct Candidate {
    double overlap;
    const Keyframe* keyframe;
  };
  std::vector<Candidate> candidates(around.size());
  const int count = static_cast<int>(around.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    candidates[i] = {overlap_share(cloud, expected, target_of(*around[i]), camera_, registration_),
                     around[i]};
  }
  // The last is taken at any rate: a frame may overlap nothing else.
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return candidate.overlap < options_.min_target_overlap && candidate.keyframe != around.back();
  });
  // Stable from the last on, so that equal overlap prefers the recent.
  std::ranges::reverse(candidates);
  std::ranges::stable_sort(candidates, std::ranges::greater(), &Candidate::overlap);
  std::vector<const Keyframe*> targets;
  for (const Candidate& candidate : candidates) {
    if (static_cast<int>(targets.size()) == options_.targets) break;
    targets.push_back(candidate.keyframe);
  }
  return targets;
}

void Odometry::restart(const StampedPose& pose) {
  last_ = pose;
  before_last_.reset();
  uncertainty_.reset();
  frames_since_registered_ = 0;
}

void Odometry::move(const Pose& new_from_old_world) {
  for (std::optional<StampedPose>* pose : {&last_, &before_last_}) {
    if (*pose) (*pose)->world_from_camera = new_from_old_world * (*pose)->world_from_camera;
  }
  uncertainty_.turn(new_from_old_world.linear());
}

void Odometry::accept(const StampedPose& pose) {
  before_last_ = last_;
  last_ = pose;
  frames_since_registered_ = 0;
}

}  // namespace tofmap
