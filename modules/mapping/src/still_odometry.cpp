// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/still_odometry.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

using CloudPointer = std::shared_ptr<const SurfaceCloud>;

/// Number of frames since the beginning of a map, or since something in front was found to move, in
/// which the background is registered by itself.
constexpr int frames_until_trusted = 15;

/// Whether a registration with fewer points contradicts another one: they differ by more than
/// registrations of still scenes do, by what the former knows.
bool contradicts(const RegistrationResult& one, const RegistrationResult& other) {
  constexpr double least_m = 0.005;
  constexpr double least_sigmas = 6;
  const auto twist = twist_between(other.world_from_camera, one.world_from_camera);
  double squared_sigmas = 0;
  for (const auto& information : one.target_information) {
    squared_sigmas += twist.dot(information * twist);
  }
  return twist.tail<3>().norm() > least_m && squared_sigmas > least_sigmas * least_sigmas;
}

/// Of a keyframe that is not connected with the others: no difference tells of motion.
constexpr PoseSpread unknown_spread{.rotation_rad2 = 0, .translation_m2 = 1e6};

/// The targets of a registered frame among some keyframes, in the order of the targets, and the
/// first of the keyframes. `spreads` are those of the keyframes around, relative to one of them.
std::vector<ComparedKeyframe> targets_and_first(const TrackingResult& frame,
                                                std::span<const Keyframe* const> keyframes,
                                                const std::map<int, PoseSpread>& spreads) {
  const auto spread_to = [&](int id) {
    const auto known = spreads.find(id);
    return known != spreads.end() ? known->second : unknown_spread;
  };
  // The targets determine the pose together, as well as their poses are known.
  PoseSpread of_targets;
  for (const int id : frame.targets) of_targets = larger(of_targets, spread_to(id));
  const PoseSpread of_frame = of_targets + frame.spread;
  std::vector<ComparedKeyframe> found;
  for (std::size_t i = 0; i < frame.targets.size(); ++i) {
    const auto target = std::ranges::find(keyframes, frame.targets[i], &Keyframe::id);
    if (target == keyframes.end()) continue;
    const PoseSpread by_itself = spread_of(frame.target_covariances[i]);
    found.push_back({*target, smaller(by_itself, of_frame + spread_to((*target)->id))});
  }
  const Keyframe* first = keyframes.front();
  if (std::ranges::find(found, first, &ComparedKeyframe::keyframe) == found.end()) {
    found.push_back({first, of_frame + spread_to(first->id)});
  }
  return found;
}

}  // namespace

std::vector<CleanedKeyframe> exchange_clouds(std::span<const CleanedKeyframe> others,
                                             KeyframeGraph& keyframes) {
  std::vector<CleanedKeyframe> before;
  for (const CleanedKeyframe& other : others) {
    before.push_back({other.id, keyframes[other.id].cloud});
    keyframes.set_cloud(other.id, other.cloud);
  }
  return before;
}

StillOdometry::StillOdometry(const CameraModel& camera, const OdometryOptions& options,
                             const RegistrationOptions& registration,
                             const LoopOptions& recognition)
    : camera_(camera),
      leaves_out_moving_(options.leave_out_moving &&
                         registration.method == RegistrationMethod::projective),
      odometry_(camera, options, registration, recognition),
      moving_(camera) {}

StillTracking StillOdometry::track(double timestamp_s, const CloudPointer& cloud,
                                   std::span<const Keyframe* const> around,
                                   std::span<const Keyframe* const> compared,
                                   KeyframeGraph& keyframes) {
  if (!leaves_out_moving_) return {odometry_.track(timestamp_s, *cloud, around), cloud, {}};
  const Odometry before = odometry_;
  const CloudPointer expected = moving_.without_known(cloud, odometry_.expected_pose(timestamp_s));
  // Until they are found, things that move contradict the free space of keyframes.
  const bool may_contradict = !compared.empty();
  TrackingResult first = odometry_.track(timestamp_s, *expected, around, may_contradict);
  const bool is_of_background = track_background(timestamp_s, expected, around, before, first);
  if (first.status != TrackingStatus::tracked || compared.empty()) return {first, cloud, {}};
  const auto spreads = keyframes.well_connected_to(around.back()->id);
  const Motion motion =
      moving_.find(cloud, first.world_from_camera, targets_and_first(first, compared, spreads));
  const CloudPointer still = is_of_background ? moving_.background(motion.still) : motion.still;
  const std::vector<CleanedKeyframe> as_before = exchange_clouds(motion.keyframes, keyframes);
  TrackingResult result = first;
  if (!motion.is_empty() || first.contradicts_targets) {
    const Odometry after_first = std::exchange(odometry_, before);
    result = odometry_.track(timestamp_s, *still, around);
    if (!result.registered() && first.contradicts_targets) {  // not by what moves
      exchange_clouds(as_before, keyframes);
      return {result, cloud, {}};
    }
    if (!result.registered()) {
      result = first;
      odometry_ = after_first;
    }
  }
  moving_.remember(motion);
  return {result, still, as_before};
}

/// In the first frames of a map the motion of the camera is not known yet, and registration may
/// lock onto people who are there from the beginning. Then, and whenever a cloud fits worse than is
/// usual, it is also registered without the things in front of others. If that contradicts `all`,
/// the registration of the whole cloud, something in front moves: `all` is replaced, and the result
/// is true.
bool StillOdometry::track_background(double timestamp_s, const CloudPointer& cloud,
                                     std::span<const Keyframe* const> around,
                                     const Odometry& before, TrackingResult& all) {
  if (around.empty()) return false;
  const bool is_trusted = ++frames_since_front_moved_ > frames_until_trusted;
  if (is_trusted && all.status == TrackingStatus::tracked &&
      before.fits_as_usual(all.registration)) {
    return false;
  }
  const CloudPointer background = moving_.background(cloud);
  if (background == cloud) return false;
  const Odometry after_all = std::exchange(odometry_, before);
  const TrackingResult behind = odometry_.track(timestamp_s, *background, around);
  if (behind.status == TrackingStatus::tracked &&
      (all.status != TrackingStatus::tracked ||
       contradicts(behind.registration, all.registration))) {
    frames_since_front_moved_ = 0;
    all = behind;
    return true;
  }
  odometry_ = after_all;
  return false;
}

void StillOdometry::start_anew() {
  odometry_.start_anew();
  moving_ = MovingRegions(camera_);
  frames_since_front_moved_ = 0;
}

void StillOdometry::move(const Pose& new_from_old_world) {
  odometry_.move(new_from_old_world);
  moving_.move(new_from_old_world);
}

}  // namespace tofmap
