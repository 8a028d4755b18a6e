// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_closure.hpp"

#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_graph.hpp"
#include "tofmap/mapping/place_recognition.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Largest correction by a place that was recognised farther away than ICP reaches. The drift would
/// be larger in one of twenty cases; another place that looks the same is more likely then.
constexpr double most_recognised_sigmas = 2;

/// The search for a loop of a keyframe.
struct LoopSearch {
  const Keyframe& keyframe;
  std::span<const Keyframe> keyframes;
  std::span<const std::optional<PoseSpread>> spreads;
  const CameraModel& camera;
  const LoopOptions& options;
  const RegistrationOptions& registration;

  MotionPrior drift_from(const Keyframe& other) const;
  bool is_within(double reach_m, double reach_rad, const Keyframe& other) const;
  bool may_see_the_same(const Keyframe& other) const;
  std::vector<const Keyframe*> candidates() const;
};

/// The prior of the keyframe's pose relative to an earlier keyframe of its map.
MotionPrior LoopSearch::drift_from(const Keyframe& other) const {
  MotionPrior prior =
      drift_prior(keyframe.world_from_camera, keyframe.path_m - other.path_m, options);
  const PoseSpread spread = spreads[static_cast<std::size_t>(other.id)].value_or(PoseSpread{});
  prior.rotation_sigma_rad = std::hypot(prior.rotation_sigma_rad, spread.rotation_sigma_rad());
  prior.translation_sigma_m = std::hypot(prior.translation_sigma_m, spread.translation_sigma_m());
  return prior;
}

/// Whether the camera of an earlier keyframe may be within a distance and a rotation, as far as the
/// keyframe's pose relative to it is known.
bool LoopSearch::is_within(double reach_m, double reach_rad, const Keyframe& other) const {
  const MotionPrior drift = drift_from(other);
  const Pose& pose = keyframe.world_from_camera;
  return (pose.translation() - other.world_from_camera.translation()).norm() <
             reach_m + most_drift_sigmas * drift.translation_sigma_m &&
         rotation_angle_rad(pose, other.world_from_camera) <
             reach_rad + most_drift_sigmas * drift.rotation_sigma_rad;
}

/// Whether an earlier keyframe may see the same place, and was not registered with the keyframe by
/// odometry anyway.
bool LoopSearch::may_see_the_same(const Keyframe& other) const {
  const std::optional<PoseSpread>& spread = spreads[static_cast<std::size_t>(other.id)];
  const bool is_well_connected =
      spread && spread->translation_sigma_m() <= KeyframeGraph::well_connected_sigma_m;
  if (other.map != keyframe.map ||
      (is_well_connected && other.id + options.min_keyframes > keyframe.id)) {
    return false;
  }
  return is_within(options.radius_m, options.max_rotation_rad, other);
}

std::vector<const Keyframe*> LoopSearch::candidates() const {
  std::vector<const Keyframe*> earlier;
  for (const Keyframe& other : keyframes.first(static_cast<std::size_t>(keyframe.id))) {
    if (may_see_the_same(other)) earlier.push_back(&other);
  }
  return earlier;
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
  std::vector<Overlap> overlaps;
  for (const Keyframe* other : earlier) {
    const double share = overlap_share(*keyframe.cloud, keyframe.world_from_camera,
                                       target_of(*other), camera, registration);
    if (share >= options.min_overlap) overlaps.push_back({other, share});
  }
  std::ranges::stable_sort(overlaps, std::ranges::greater(), &Overlap::share);
  if (overlaps.size() > most) overlaps.resize(most);
  std::vector<const Keyframe*> best;
  for (const Overlap& overlap : overlaps) best.push_back(overlap.keyframe);
  return best;
}

/// Registers the keyframe from its current pose with the earlier keyframes that it overlaps most.
LoopCandidate find_where_believed(const LoopSearch& search,
                                  const std::vector<const Keyframe*>& earlier) {
  LoopCandidate candidate;
  const auto overlapping =
      best_overlaps(search.keyframe, earlier, search.camera, search.options, search.registration);
  if (overlapping.empty()) return candidate;
  const MotionPrior drift = search.drift_from(*overlapping.front());
  if (drift.translation_sigma_m > recognition_reach_m) return candidate;
  candidate.from = overlapping.front()->id;
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* other : overlapping) targets.push_back(target_of(*other));
  candidate.registration = register_from_afar(*search.keyframe.cloud, targets, search.camera, drift,
                                              search.registration);
  return candidate;
}

/// Recognises the place that the keyframe sees among keyframes of earlier visits near which the
/// camera may be. Empty if that fails, or if the camera cannot have drifted that far.
std::optional<LoopCandidate> find_where_alike(const LoopSearch& search,
                                              std::vector<const Keyframe*> earlier) {
  const Keyframe& keyframe = search.keyframe;
  std::erase_if(earlier, [&](const Keyframe* other) {
    return other->id + search.options.min_keyframes > keyframe.id ||
           keyframe.place.difference(other->place) > alike_difference ||
           !search.is_within(recognition_reach_m, recognition_reach_rad, *other);
  });
  if (earlier.empty()) return std::nullopt;
  const auto before = search.keyframes.first(static_cast<std::size_t>(keyframe.id));
  const auto has_drifted_to = [&](const Keyframe& other, const Pose& pose) {
    return prior_deviation_sigmas(search.drift_from(other), pose) <= most_recognised_sigmas;
  };
  const auto found = recognise(keyframe, std::move(earlier), has_drifted_to, before, search.camera,
                               search.options, search.registration);
  if (!found) return std::nullopt;
  return LoopCandidate{.from = found->from, .registration = found->registration, .edge = {}};
}

}  // namespace

std::vector<OptionField<LoopOptions>> LoopOptions::fields() {
  using O = LoopOptions;
  return {
      {"close", &O::close, 0, 1, "", "searches for loops and corrects the path with them"},
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

bool confirms_place(const Keyframe& keyframe, const SurfaceCloud& cloud,
                    const RegistrationResult& result, const CameraModel& camera,
                    const LoopOptions& options) {
  return is_verified(result, options) &&
         !contradicts_free_space({&cloud, result.world_from_camera}, target_of(keyframe), camera);
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
  edge.covariance = rotated(covariance, from.world_from_camera.linear().transpose());
  widen(edge, shared_sigma_rad, shared_sigma_m);
  return edge;
}

PoseEdge loop_edge(const Keyframe& from, int to, const RegistrationResult& result) {
  PoseEdge edge =
      edge_of(from, to, result.world_from_camera, covariance_of(result.target_information.front()));
  edge.may_be_wrong = true;
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
                        std::span<const std::optional<PoseSpread>> spreads,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration) {
  const LoopSearch search{keyframe, keyframes, spreads, camera, options, registration};
  const auto earlier = search.candidates();
  LoopCandidate candidate = find_where_believed(search, earlier);
  if (candidate.from < 0 ||
      !confirms_place(keyframes[static_cast<std::size_t>(candidate.from)], *keyframe.cloud,
                      candidate.registration, camera, options)) {
    const auto alike = find_where_alike(search, earlier);
    if (!alike) return candidate;
    candidate = *alike;
  }
  const PoseEdge edge = loop_edge(keyframes[static_cast<std::size_t>(candidate.from)], keyframe.id,
                                  candidate.registration);
  // A pose that the other targets, or the prior, determine tells nothing of this keyframe.
  const double sigma_m = spread_of(edge.covariance).translation_sigma_m();
  if (sigma_m <= KeyframeGraph::well_connected_sigma_m) candidate.edge = edge;
  return candidate;
}

}  // namespace tofmap
