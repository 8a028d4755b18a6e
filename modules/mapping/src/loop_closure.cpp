// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_closure.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// Smallest standard deviations of the drift prior: registration corrects errors of this size.
constexpr double least_prior_m = 0.05;
constexpr double least_prior_rad = 0.03;

/// Standard deviations of errors that neighbouring frames share, which the covariance of a
/// registration does not include.
constexpr double shared_sigma_m = 0.002;
constexpr double shared_sigma_rad = 0.0005;

/// Largest PlaceDescriptor::difference() of a keyframe that is tried.
constexpr double alike_difference = 0.3;

/// Largest correction by a loop, in standard deviations of drift.
constexpr double most_drift_sigmas = 3;

/// Earlier keyframes that, by their poses, may see the same place as `keyframe`.
std::vector<const Keyframe*> earlier_around(const Keyframe& keyframe,
                                            std::span<const Keyframe> keyframes,
                                            const LoopOptions& options) {
  std::vector<const Keyframe*> earlier;
  const Pose& pose = keyframe.world_from_camera;
  for (const Keyframe& other : keyframes) {
    if (other.id + options.min_keyframes > keyframe.id) break;
    if (other.map != keyframe.map) continue;
    if ((pose.translation() - other.world_from_camera.translation()).norm() < options.radius_m &&
        rotation_angle_rad(pose, other.world_from_camera) < options.max_rotation_rad) {
      earlier.push_back(&other);
    }
  }
  return earlier;
}

MotionPrior drift_prior(const Keyframe& keyframe, const Keyframe& other,
                        const LoopOptions& options) {
  return drift_prior(keyframe.world_from_camera, keyframe.path_m - other.path_m, options);
}

/// The three keyframes of `earlier` that see most of the points of `keyframe`, and at least
/// `min_overlap` of them, in descending order of overlap.
std::vector<const Keyframe*> best_overlaps(const Keyframe& keyframe,
                                           const std::vector<const Keyframe*>& earlier,
                                           const CameraModel& camera, const LoopOptions& options,
                                           const RegistrationOptions& registration) {
  struct Overlap {
    const Keyframe* keyframe;
    double share;
  };
  constexpr std::size_t most = 3;
  RegistrationOptions coarse = registration;
  coarse.source_stride_px = 4 * registration.source_stride_px;  // a few hundred points are enough
  std::vector<Overlap> overlaps;
  for (const Keyframe* other : earlier) {
    const double share = overlap_share(*keyframe.cloud, keyframe.world_from_camera,
                                       target_of(*other), camera, coarse);
    if (share >= options.min_overlap) overlaps.push_back({other, share});
  }
  std::ranges::stable_sort(overlaps, std::ranges::greater(), &Overlap::share);
  if (overlaps.size() > most) overlaps.resize(most);
  std::vector<const Keyframe*> best;
  for (const Overlap& overlap : overlaps) best.push_back(overlap.keyframe);
  return best;
}

/// Registers `keyframe` from its current pose with the earlier keyframes that it overlaps most.
LoopCandidate find_where_believed(const Keyframe& keyframe,
                                  const std::vector<const Keyframe*>& earlier,
                                  const CameraModel& camera, const LoopOptions& options,
                                  const RegistrationOptions& registration) {
  LoopCandidate candidate;
  const auto overlapping = best_overlaps(keyframe, earlier, camera, options, registration);
  if (overlapping.empty()) return candidate;
  candidate.from = overlapping.front()->id;
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* other : overlapping) targets.push_back(target_of(*other));
  candidate.registration =
      register_to_targets(*keyframe.cloud, targets, camera,
                          drift_prior(keyframe, *overlapping.front(), options), registration);
  return candidate;
}

/// Registers `keyframe` with the most similar earlier keyframe, from the pose of that one. Empty if
/// no keyframe is similar enough, or if the result is not verified.
std::optional<LoopCandidate> find_where_alike(const Keyframe& keyframe,
                                              std::span<const Keyframe> keyframes,
                                              const std::vector<const Keyframe*>& earlier,
                                              const CameraModel& camera, const LoopOptions& options,
                                              const RegistrationOptions& registration) {
  constexpr std::size_t one = 1;
  const auto alike = most_alike(keyframe.place, earlier, one);
  if (alike.empty()) return std::nullopt;
  const Keyframe& other = *alike.front();
  if (keyframe.place.difference(other.place) > alike_difference) return std::nullopt;
  const auto before = keyframes.first(static_cast<std::size_t>(keyframe.id));
  const RegistrationResult found =
      register_near(other, *keyframe.cloud, before, camera, registration);
  const double drift_sigmas =
      prior_deviation_sigmas(drift_prior(keyframe, other, options), found.world_from_camera);
  if (drift_sigmas > most_drift_sigmas || !is_verified(found, options)) return std::nullopt;
  return LoopCandidate{.from = other.id, .registration = found, .edge = {}};
}

}  // namespace

std::vector<OptionField<LoopOptions>> LoopOptions::fields() {
  using O = LoopOptions;
  return {
      {"close", &O::close, 0, 1, "", "searches for loops, and corrects the path by them"},
      {"radius_m", &O::radius_m, 0.1, 100, "m",
       "loops are searched for among keyframes at most this far away"},
      {"max_rotation_rad", &O::max_rotation_rad, 0.01, 3.2, "rad",
       "loops are searched for among keyframes that are rotated by at most this"},
      {"min_keyframes", &O::min_keyframes, 1, 100000, "",
       "smallest number of keyframes from one end of a loop to the other"},
      {"min_overlap", &O::min_overlap, 0.01, 1, "",
       "smallest share of a keyframe's points that must have a correspondence in earlier "
       "keyframes"},
      {"min_inlier_ratio", &O::min_inlier_ratio, 0, 1, "",
       "smallest share of the correspondences of a loop that must fit its pose"},
      {"drift_share", &O::drift_share, 0, 1, "",
       "standard deviation of the drift in position, as a share of the length of the path since "
       "the place was seen first"},
      {"kernel_width", &O::kernel_width, 0.5, 100, "",
       "width of the kernel that down-weights loop constraints with large errors, in standard "
       "deviations"},
  };
}

MotionPrior drift_prior(const Pose& expected, double path_m, const LoopOptions& options) {
  const double drift_m = options.drift_share * path_m;
  return {.world_from_camera = expected,
          .rotation_sigma_rad = std::hypot(least_prior_rad, drift_rad_per_drift_m * drift_m),
          .translation_sigma_m = std::hypot(least_prior_m, drift_m)};
}

double support(const RegistrationResult& result) {
  return succeeded(result.status) ? result.overlap * result.inlier_ratio : 0;
}

bool is_verified(const RegistrationResult& result, const LoopOptions& options) {
  return result.status == RegistrationStatus::converged && result.overlap >= options.min_overlap &&
         result.inlier_ratio >= options.min_inlier_ratio && result.degenerate_directions == 0;
}

Eigen::Matrix<double, 6, 6> covariance_of(const Eigen::Matrix<double, 6, 6>& information) {
  constexpr double unseen_rad = 0.5;
  constexpr double unseen_m = 1;
  Eigen::Matrix<double, 6, 6> sum = information;
  sum.diagonal().head<3>().array() += 1 / (unseen_rad * unseen_rad);
  sum.diagonal().tail<3>().array() += 1 / (unseen_m * unseen_m);
  return sum.inverse();
}

PoseEdge edge_of(const Keyframe& from, int to, const Pose& world_from_camera,
                 const Eigen::Matrix<double, 6, 6>& covariance) {
  PoseEdge edge;
  edge.from = from.id;
  edge.to = to;
  edge.from_from_to = from.world_from_camera.inverse() * world_from_camera;
  // The covariance of a registration is along the world's axes, that of an edge along those of
  // `from`.
  Eigen::Matrix<double, 6, 6> rotation = Eigen::Matrix<double, 6, 6>::Zero();
  rotation.topLeftCorner<3, 3>() = from.world_from_camera.linear().transpose();
  rotation.bottomRightCorner<3, 3>() = rotation.topLeftCorner<3, 3>();
  edge.covariance = rotation * covariance * rotation.transpose();
  widen(edge, shared_sigma_rad, shared_sigma_m);
  return edge;
}

RegistrationResult register_from_afar(const SurfaceCloud& cloud,
                                      std::span<const RegistrationTarget> targets,
                                      const CameraModel& camera, const MotionPrior& prior,
                                      const RegistrationOptions& registration) {
  constexpr double max_distance_m = 1;
  constexpr int iterations = 40;
  RegistrationOptions wide = registration;
  wide.max_correspondence_distance_m =
      std::max(registration.max_correspondence_distance_m,
               std::min(max_distance_m, 2 * prior.translation_sigma_m));
  wide.max_iterations = std::max(registration.max_iterations, iterations);
  MotionPrior closer = prior;
  closer.world_from_camera =
      register_to_targets(cloud, targets, camera, prior, wide).world_from_camera;
  return register_to_targets(cloud, targets, camera, closer, registration);
}

RegistrationResult register_near(const Keyframe& keyframe, const SurfaceCloud& cloud,
                                 std::span<const Keyframe> keyframes, const CameraModel& camera,
                                 const RegistrationOptions& registration) {
  const MotionPrior prior{.world_from_camera = keyframe.world_from_camera,
                          .rotation_sigma_rad = recognition_reach_rad,
                          .translation_sigma_m = recognition_reach_m};
  return register_from_afar(cloud, targets_around(keyframe, keyframes), camera, prior,
                            registration);
}

LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration) {
  const auto earlier = earlier_around(keyframe, keyframes, options);
  LoopCandidate candidate = find_where_believed(keyframe, earlier, camera, options, registration);
  if (!is_verified(candidate.registration, options)) {
    const auto alike =
        find_where_alike(keyframe, keyframes, earlier, camera, options, registration);
    if (!alike) return candidate;
    candidate = *alike;
  }
  const Keyframe& from = keyframes[static_cast<std::size_t>(candidate.from)];
  candidate.edge = edge_of(from, keyframe.id, candidate.registration.world_from_camera,
                           covariance_of(candidate.registration.target_information.front()));
  candidate.edge->may_be_wrong = true;
  return candidate;
}

}  // namespace tofmap
