// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/odometry.hpp"

#include "registration_choice.hpp"
#include "target_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/rotation_search.hpp"
#include "tofmap/mapping/verification.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tofmap {
namespace {

/// Longest time, in frame periods, since the last registered frame for which the camera is assumed
/// to have kept its motion.
constexpr double periods_of_steady_tracking = 3.5;

bool is_elsewhere(const RegistrationResult& one, const RegistrationResult& other) {
  constexpr double apart_m = 0.1;
  constexpr double apart_rad = 0.05;
  return !are_near(one.world_from_camera, other.world_from_camera, apart_m, apart_rad);
}

/// A registered frame is tried from other rotations as well if its pose differs from the predicted
/// one by more than this many standard deviations, or if its support is less than this share of
/// what is usual.
constexpr double suspect_sigmas = 4;
constexpr double suspect_share = 0.75;

/// Smallest inlier ratio of a registration that fits as usual, relative to recent ones.
constexpr double least_inlier_share = 0.95;

/// Largest rotation from the last pose that is tried: a turn by 30 degrees and what ICP adds.
constexpr double reach_rad = 0.6;
constexpr std::size_t most_rotations = 4;

/// Standard deviations of the prior around a rotation that was found by search: the step of its
/// grid, and a translation that at `max_prior_sigmas` allows half a metre a frame.
constexpr double turned_sigma_rad = 0.07;
constexpr double turned_sigma_m = 0.06;

std::vector<RegistrationTarget> targets_of(const std::vector<const Keyframe*>& keyframes) {
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* keyframe : keyframes) targets.push_back(target_of(*keyframe));
  return targets;
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
       "distance from all nearby keyframes at which a frame becomes a keyframe; twice this "
       "distance from those of an earlier visit, half of it while a loop waits for others; a "
       "standard deviation of a fifth of it also makes a frame a keyframe, as does an overlap of "
       "less than 70 %"},
      {"keyframe_rotation_rad", &O::keyframe_rotation_rad, 0.01, 3.2, "rad",
       "rotation from all nearby keyframes at which a frame becomes a keyframe; twice this "
       "rotation from those of an earlier visit"},
      {"keyframes_around", &O::keyframes_around, 1, 1000, "",
       "number of keyframes near the camera that a frame may be registered with"},
      {"targets", &O::targets, 1, 16, "",
       "largest number of keyframes that a frame is registered with: those that overlap it most, "
       "and one that constrains a direction which these do not"},
      {"min_target_overlap", &O::min_target_overlap, 0, 1, "",
       "smallest share of a frame's points that a keyframe must see to be registered with"},
      {"prior_rotation_sigma_rad", &O::prior_rotation_sigma_rad, 1e-4, 3.2, "rad",
       "standard deviation of the change in frame-to-frame rotation, per axis and frame; less "
       "while the motion is steady"},
      {"prior_translation_sigma_m", &O::prior_translation_sigma_m, 1e-4, 10, "m",
       "standard deviation of the change in frame-to-frame translation, per axis and frame; less "
       "while the motion is steady"},
      {"max_prior_sigmas", &O::max_prior_sigmas, 1, 1000, "",
       "largest difference from the predicted pose, in standard deviations; a pose that differs "
       "more is rejected"},
      {"check_poses", &O::check_poses, 0, 1, "",
       "tries other rotations for a frame whose pose is unlikely, and rejects a pose that fits far "
       "worse than is usual or contradicts free space; always off without unwrapping and with "
       "PCL's methods"},
      {"leave_out_moving", &O::leave_out_moving, 0, 1, "",
       "finds people and other things that move, and leaves them out of registration and map; "
       "always off without unwrapping and with PCL's methods"},
  };
}

std::span<const NamedValue<TrackingStatus>> named_values(TrackingStatus) {
  static constexpr std::array<NamedValue<TrackingStatus>, 7> statuses{
      {{"first", TrackingStatus::first},
       {"tracked", TrackingStatus::tracked},
       {"no_surface", TrackingStatus::no_surface},
       {"lost", TrackingStatus::lost},
       {"implausible", TrackingStatus::implausible},
       {"relocalised", TrackingStatus::relocalised},
       {"repeated", TrackingStatus::repeated}}};
  return statuses;
}

Odometry::Odometry(const CameraModel& camera, const OdometryOptions& options,
                   const RegistrationOptions& registration, const LoopOptions& recognition)
    : camera_(camera),
      options_(options),
      registration_(registration),
      recognition_(recognition),
      uncertainty_(options.prior_rotation_sigma_rad, options.prior_translation_sigma_m),
      since_keyframe_(uncertainty_) {}

TrackingResult Odometry::track(double timestamp_s, const SurfaceCloud& cloud,
                               std::span<const Keyframe* const> around, bool may_contradict) {
  TrackingResult result;
  ++frames_since_registered_;
  if (!has_surface(cloud, registration_.min_correspondences)) {
    result.status = TrackingStatus::no_surface;
    return result;
  }
  if (!last_) {
    result.status = TrackingStatus::first;
    uncertainty_.forget_velocity();
    since_keyframe_.forget_velocity();
    accept({timestamp_s, result.world_from_camera});
    return result;
  }
  Attempt attempt = register_as_predicted(timestamp_s, cloud, around);
  double periods = std::max(1.0, periods_since_registered(timestamp_s));
  result.status = judge(attempt, timestamp_s);
  if (is_suspect(attempt)) {
    const auto turned = register_turned(periods, cloud, around);
    if (turned && (result.status != TrackingStatus::tracked ||
                   is_clearly_better(turned->registration, attempt.registration))) {
      attempt = *turned;
      result.status = judge(attempt, timestamp_s);
      // The motion changed by more than the prior allows, as it may over that many frames.
      periods = std::max(periods, prior_deviation_sigmas(predict(timestamp_s),
                                                         attempt.registration.world_from_camera));
    } else if (contradicts_targets(attempt, cloud)) {
      result.contradicts_targets = true;
      if (!may_contradict) result.status = TrackingStatus::lost;
    }
  }
  for (const Keyframe* target : attempt.targets) result.targets.push_back(target->id);
  result.registration = attempt.registration;
  if (result.status != TrackingStatus::tracked) return result;
  result.world_from_camera = result.registration.world_from_camera;
  result.constraints = constraints_of(result.registration, attempt.targets);
  result.registration.target_equations.clear();
  note_change(timestamp_s, result.registration);
  learn_covariances(periods, attempt, result);
  constexpr double share_of_newest = 0.1;
  usual_support_ += share_of_newest * (support(result.registration) - usual_support_);
  usual_inlier_ratio_ += share_of_newest * (result.registration.inlier_ratio - usual_inlier_ratio_);
  accept({timestamp_s, result.world_from_camera});
  return result;
}

Odometry::Attempt Odometry::register_from(const MotionPrior& prior, const SurfaceCloud& cloud,
                                          std::span<const Keyframe* const> around) const {
  Attempt attempt;
  attempt.prior = prior;
  attempt.targets = choose_targets(cloud, prior, around, camera_, options_, registration_);
  RegistrationOptions registration = registration_;
  // A distant initial pose takes more iterations.
  constexpr int times = 3;
  if (prior.translation_sigma_m > periods_of_steady_tracking * options_.prior_translation_sigma_m) {
    registration.max_iterations *= times;
  }
  attempt.registration =
      register_to_targets(cloud, targets_of(attempt.targets), camera_, prior, registration);
  return attempt;
}

/// Registers a frame as if its motion were as steady as that of recent frames, which keeps the pose
/// where the surfaces hardly do. Empty if that is no steadier than `prior` allows anyway, if
/// registration fails, or if the motion has changed.
std::optional<Odometry::Attempt> Odometry::register_as_steady(
    const MotionPrior& prior, double timestamp_s, const SurfaceCloud& cloud,
    std::span<const Keyframe* const> around) const {
  // A prior that changes of the motion exceed would hold the pose back.
  constexpr double changed_sigmas = 3;
  const MotionUncertainty::Twist sigmas =
      periods_since_registered(timestamp_s) * uncertainty_.change_sigmas();
  const MotionPrior steady{prior.world_from_camera, sigmas[0], sigmas[3]};
  if (steady.rotation_sigma_rad >= prior.rotation_sigma_rad &&
      steady.translation_sigma_m >= prior.translation_sigma_m) {
    return std::nullopt;
  }
  Attempt attempt = register_from(steady, cloud, around);
  const RegistrationResult& found = attempt.registration;
  if (!succeeded(found.status) ||
      prior_deviation_sigmas(steady, found.world_from_camera) > changed_sigmas) {
    return std::nullopt;
  }
  attempt.prior = prior;
  return attempt;
}

/// Registers a frame from the pose that constant velocity predicts, and after a gap from the last
/// pose as well, since the camera may have stood still instead.
Odometry::Attempt Odometry::register_as_predicted(double timestamp_s, const SurfaceCloud& cloud,
                                                  std::span<const Keyframe* const> around) const {
  const MotionPrior prior = predict(timestamp_s);
  if (!is_after_gap(timestamp_s)) {
    if (const auto steady = register_as_steady(prior, timestamp_s, cloud, around)) return *steady;
  }
  Attempt moving = register_from(prior, cloud, around);
  MotionPrior standing = prior;
  standing.world_from_camera = last_->world_from_camera;
  if (!is_after_gap(timestamp_s) ||
      prior_deviation_sigmas(prior, standing.world_from_camera) == 0) {
    return moving;
  }
  Attempt still = register_from(standing, cloud, around);
  return support(still.registration) > support(moving.registration) ? still : moving;
}

/// Registers a frame from the rotations around the last pose at which its ranges fit those of the
/// keyframes, `periods` frame periods later. Empty if no result is verified, or if two different
/// ones fit about equally well.
std::optional<Odometry::Attempt> Odometry::register_turned(
    double periods, const SurfaceCloud& cloud, std::span<const Keyframe* const> around) const {
  std::vector<Attempt> verified;
  for (const Pose& pose :
       search_rotations(cloud, around, last_->world_from_camera, reach_rad, most_rotations)) {
    Attempt attempt;
    attempt.prior = {pose, turned_sigma_rad, periods * turned_sigma_m};
    attempt.targets =
        choose_targets(cloud, attempt.prior, around, camera_, options_, registration_);
    attempt.registration = register_from_afar(cloud, targets_of(attempt.targets), camera_,
                                              attempt.prior, registration_);
    if (is_turn(attempt.registration) && !contradicts_targets(attempt, cloud)) {
      verified.push_back(std::move(attempt));
    }
  }
  if (verified.empty()) return std::nullopt;
  const auto best = std::ranges::max_element(
      verified, {}, [](const Attempt& attempt) { return support(attempt.registration); });
  const bool is_ambiguous = std::ranges::any_of(verified, [&](const Attempt& other) {
    return !is_clearly_better(best->registration, other.registration) &&
           is_elsewhere(best->registration, other.registration);
  });
  return is_ambiguous ? std::nullopt : std::optional(*best);
}

/// Whether a result after a turn can be right: it is verified as a loop is, except that the prior
/// may determine one direction, such as along the wall that the camera looked at before it turned.
bool Odometry::is_turn(const RegistrationResult& result) const {
  RegistrationResult in_other_directions = result;
  if (result.degenerate_directions == 1) in_other_directions.degenerate_directions = 0;
  return is_verified(in_other_directions, recognition_);
}

/// Whether the camera may have moved otherwise than expected: registration failed or did not
/// converge, or the result is far from the predicted pose, or it fits worse than is usual, or the
/// frame before was not registered. PCL's methods are compared by their results as they are.
bool Odometry::is_suspect(const Attempt& attempt) const {
  if (!options_.check_poses || registration_.method != RegistrationMethod::projective) return false;
  return frames_since_registered_ > 1 ||
         attempt.registration.status != RegistrationStatus::converged ||
         prior_deviation_sigmas(attempt.prior, attempt.registration.world_from_camera) >
             suspect_sigmas ||
         support(attempt.registration) < suspect_share * usual_support_;
}

/// Whether a result fits the surfaces nearly as well as is usual. Of a frame that sees much that is
/// new, few points fit, but those that have a correspondence do.
bool Odometry::is_credible(const RegistrationResult& result) const {
  constexpr double least_share = 0.5;
  const double share = support(result) / usual_support_;
  if (result.status != RegistrationStatus::converged) return share >= suspect_share;
  return share >= least_share || fits_as_usual(result);
}

bool Odometry::fits_as_usual(const RegistrationResult& result) const {
  return result.inlier_ratio >= least_inlier_share * usual_inlier_ratio_;
}

/// Whether a successful registration contradicts the free space of the keyframe that it overlaps
/// most.
bool Odometry::contradicts_targets(const Attempt& attempt, const SurfaceCloud& cloud) const {
  if (attempt.targets.empty()) return false;
  const Keyframe& best = *attempt.targets.front();
  const bool is_of_earlier_recording = std::ranges::any_of(
      attempt.targets, [&](const Keyframe* other) { return other->recording > best.recording; });
  return contradicts_free_space({&cloud, attempt.registration.world_from_camera}, target_of(best),
                                camera_,
                                is_of_earlier_recording ? most_violations_since : most_violations);
}

TrackingStatus Odometry::judge(const Attempt& attempt, double timestamp_s) const {
  const RegistrationResult& found = attempt.registration;
  if (!succeeded(found.status)) return TrackingStatus::lost;
  if (is_suspect(attempt) && !is_credible(found)) return TrackingStatus::lost;
  if (is_after_gap(timestamp_s) && !(found.overlap >= recognition_.min_overlap &&
                                     found.inlier_ratio >= recognition_.min_inlier_ratio)) {
    return TrackingStatus::lost;
  }
  return prior_deviation_sigmas(attempt.prior, found.world_from_camera) > options_.max_prior_sigmas
             ? TrackingStatus::implausible
             : TrackingStatus::tracked;
}

bool Odometry::is_after_gap(double timestamp_s) const {
  return periods_since_registered(timestamp_s) > periods_of_steady_tracking;
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
    // The median is the frame period, since most frames follow each other even if some are dropped.
    std::vector<double> periods_s = recent_periods_s_;
    const auto usual = periods_s.begin() + static_cast<std::ptrdiff_t>((periods_s.size() - 1) / 2);
    std::ranges::nth_element(periods_s, usual);
    periods = std::max(periods, (timestamp_s - last_->timestamp_s) / *usual);
  }
  constexpr double for_ever = 1000;
  return std::min(periods, for_ever);
}

Pose Odometry::expected_pose(double timestamp_s) const {
  return last_ ? predict(timestamp_s).world_from_camera : Pose::Identity();
}

MotionPrior Odometry::predict(double timestamp_s) const {
  MotionPrior prior;
  // Every frame that could not be registered or was dropped adds uncertainty.
  const double periods = std::max(1.0, periods_since_registered(timestamp_s));
  prior.rotation_sigma_rad = periods * options_.prior_rotation_sigma_rad;
  prior.translation_sigma_m = periods * options_.prior_translation_sigma_m;
  prior.world_from_camera = last_->world_from_camera;
  // Frames that came but could not be registered suggest that the motion has changed. If frames
  // were only dropped, constant velocity remains the best prediction for some time.
  constexpr int frames_of_steady_motion = 3;
  constexpr double most_periods = 30;
  const double last_step_s = before_last_ ? last_->timestamp_s - before_last_->timestamp_s : 0;
  if (last_step_s > 0 && frames_since_registered_ <= frames_of_steady_motion) {
    const double share = (timestamp_s - last_->timestamp_s) / last_step_s;
    prior.world_from_camera = at_constant_velocity(
        before_last_->world_from_camera, last_->world_from_camera, std::min(share, most_periods));
  }
  return prior;
}

/// Learns by how much the pose of a frame differs from the predicted one.
void Odometry::note_change(double timestamp_s, const RegistrationResult& found) {
  const MotionUncertainty::Twist change =
      twist_between(predict(timestamp_s).world_from_camera, found.world_from_camera);
  const long frames = std::max(1L, std::lround(periods_since_registered(timestamp_s)));
  for (MotionUncertainty* motion : {&uncertainty_, &since_keyframe_}) {
    motion->note_change(change, found.covariance, static_cast<int>(frames));
  }
}

/// Finds the covariances of the pose relative to each target and to the latest keyframe, and the
/// spread relative to all targets. Frames since the reference tell of the motion since then, where
/// its own surfaces do not.
void Odometry::learn_covariances(double periods, const Attempt& attempt, TrackingResult& result) {
  using Covariance = MotionUncertainty::Covariance;
  const auto& information = attempt.registration.target_information;
  const auto place_of = [&](int id) {
    return static_cast<std::size_t>(std::ranges::find(attempt.targets, id, &Keyframe::id) -
                                    attempt.targets.begin());
  };
  const auto information_from = [&](std::size_t place) -> Covariance {
    return place < information.size() ? information[place] : Covariance::Zero();
  };
  for (const Covariance& of_target : information) {
    result.target_covariances.push_back(covariance_of(of_target));
  }
  const int frames = static_cast<int>(std::lround(periods));
  const std::size_t latest = place_of(latest_);
  since_keyframe_.learn(frames, information_from(latest));
  if (latest < information.size()) result.target_covariances[latest] = since_keyframe_.of_pose();
  if (latest_ >= 0) {
    result.since_keyframe = {latest_, covariance_of(since_keyframe_.of_pose().inverse())};
  }
  const std::size_t reference = place_of(reference_);
  uncertainty_.learn(frames, information_from(reference));
  std::vector<Covariance> covariances = result.target_covariances;
  if (reference < information.size()) {
    covariances[reference] = uncertainty_.of_pose();
  } else {
    // The pose of the reference relative to the targets is known well.
    covariances[0] = (covariances[0].inverse() + uncertainty_.of_pose().inverse()).inverse();
    reference_ = attempt.targets.front()->id;
    uncertainty_.restart(covariances[0]);
  }
  Covariance sum = Covariance::Zero();
  for (const Covariance& covariance : covariances) sum += covariance.inverse();
  result.covariance = sum.inverse();
  result.spread = spread_of(result.covariance);
}

void Odometry::note_keyframe(int id) {
  reference_ = id;
  uncertainty_.restart();
  latest_ = id;
  since_keyframe_.restart();
}

void Odometry::start_anew() {
  last_.reset();
  before_last_.reset();
  uncertainty_.reset();
  reference_ = -1;
  since_keyframe_.reset();
  latest_ = -1;
  usual_support_ = expected_support;
  usual_inlier_ratio_ = expected_inlier_ratio;
  frames_since_registered_ = 0;
}

void Odometry::move(const Pose& new_from_old_world) {
  for (std::optional<StampedPose>* pose : {&last_, &before_last_}) {
    if (*pose) (*pose)->world_from_camera = new_from_old_world * (*pose)->world_from_camera;
  }
  uncertainty_.rotate(new_from_old_world.linear());
  since_keyframe_.rotate(new_from_old_world.linear());
}

void Odometry::accept(const StampedPose& pose) {
  before_last_ = last_;
  last_ = pose;
  frames_since_registered_ = 0;
}

}  // namespace tofmap
