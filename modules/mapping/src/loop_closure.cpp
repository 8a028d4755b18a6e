// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_closure.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// How far off a pose may be that registration puts right, wherever drift has brought it.
constexpr double least_prior_m = 0.05;
constexpr double least_prior_rad = 0.03;

/// Drift of directions, as a share of the path: a metre's drift in position comes with this.
constexpr double drift_rad_per_drift_m = 0.3;

/// Errors that neighbouring frames share, and that no covariance of one registration tells of.
constexpr double shared_sigma_m = 0.002;
constexpr double shared_sigma_rad = 0.0005;

struct Overlap {
  const Keyframe* keyframe;
  double share;
};

bool looks_the_same_way(const Pose& one, const Pose& other, const LoopOptions& options) {
  return (one.translation() - other.translation()).norm() < options.radius_m &&
         rotation_angle_rad(one, other) < options.max_turn_rad;
}

MotionPrior loop_prior(const Keyframe& keyframe, double path_between_m,
                       const LoopOptions& options) {
  const double drift_m = options.drift_share * path_between_m;
  return {.world_from_camera = keyframe.world_from_camera,
          .rotation_sigma_rad = std::hypot(least_prior_rad, drift_rad_per_drift_m * drift_m),
          .translation_sigma_m = std::hypot(least_prior_m, drift_m)};
}

/// Earlier keyframes that see most of what the keyframe sees, the best first.
std::vector<Overlap> best_overlaps(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                                   const CameraModel& camera, const LoopOptions& options,
                                   const RegistrationOptions& registration) {
  constexpr std::size_t most_targets = 3;
  RegistrationOptions coarse = registration;
  coarse.source_stride_px = 4 * registration.source_stride_px;  // a few hundred points tell enough
  std::vector<Overlap> overlaps;
  for (const Keyframe& other : keyframes) {
    if (other.id + options.min_gap > keyframe.id) break;
    if (!looks_the_same_way(keyframe.world_from_camera, other.world_from_camera, options)) continue;
    const double share = overlap_share(*keyframe.cloud, keyframe.world_from_camera,
                                       target_of(other), camera, coarse);
    if (share >= options.min_overlap) overlaps.push_back({&other, share});
  }
  std::ranges::stable_sort(overlaps, std::ranges::greater(), &Overlap::share);
  if (overlaps.size() > most_targets) overlaps.resize(most_targets);
  return overlaps;
}

}  // namespace

std::vector<OptionField<LoopOptions>> LoopOptions::fields() {
  using O = LoopOptions;
  return {
      {"close", &O::close, 0, 1, "", "look for places seen before, and correct the path by them"},
      {"radius_m", &O::radius_m, 0.1, 100, "m", "how far apart cameras of one place may stand"},
      {"max_turn_rad", &O::max_turn_rad, 0.01, 3.2, "rad",
       "how far apart directions of view of one place may be"},
      {"min_gap", &O::min_gap, 1, 100000, "", "keyframes closer in time than this are no loop"},
      {"min_overlap", &O::min_overlap, 0.01, 1, "", "share of a keyframe that must be seen again"},
      {"min_inlier_share", &O::min_inlier_share, 0, 1, "",
       "share of the correspondences that must agree"},
      {"drift_share", &O::drift_share, 0, 1, "",
       "how far off the path may be, as a share of its length since the place was seen"},
      {"kernel_width", &O::kernel_width, 0.5, 100, "",
       "loops farther off than this, in standard deviations, lose their say"},
  };
}

bool is_verified(const RegistrationResult& result, const LoopOptions& options) {
  return result.status == RegistrationStatus::converged && result.overlap >= options.min_overlap &&
         result.inlier_share >= options.min_inlier_share && result.degenerate_directions == 0;
}

PoseEdge edge_of(const Keyframe& from, int to, const RegistrationResult& registration) {
  PoseEdge edge;
  edge.from = from.id;
  edge.to = to;
  edge.from_from_to = from.world_from_camera.inverse() * registration.world_from_camera;
  // Registration's twist is along the world's axes.
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = from.world_from_camera.linear().transpose();
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  edge.covariance = turn * registration.covariance * turn.transpose();
  edge.covariance.diagonal().head<3>().array() += shared_sigma_rad * shared_sigma_rad;
  edge.covariance.diagonal().tail<3>().array() += shared_sigma_m * shared_sigma_m;
  return edge;
}

LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        std::span<const double> path_m, const CameraModel& camera,
                        const LoopOptions& options, const RegistrationOptions& registration) {
  LoopCandidate candidate;
  const auto overlaps = best_overlaps(keyframe, keyframes, camera, options, registration);
  if (overlaps.empty()) return candidate;
  const Keyframe& best = *overlaps.front().keyframe;
  candidate.from = best.id;
  std::vector<RegistrationTarget> targets;
  for (const Overlap& overlap : overlaps) {
    targets.push_back(target_of(*overlap.keyframe));
  }
  const double path_between_m =
      path_m[static_cast<std::size_t>(keyframe.id)] - path_m[static_cast<std::size_t>(best.id)];
  candidate.registration =
      register_to_targets(*keyframe.cloud, targets, camera,
                          loop_prior(keyframe, path_between_m, options), registration);
  if (is_verified(candidate.registration, options)) {
    candidate.edge = edge_of(best, keyframe.id, candidate.registration);
    candidate.edge->may_be_wrong = true;
  }
  return candidate;
}

}  // namespace tofmap
