// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_closure.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/keyframe_graph.hpp"
#include "tofmap/mapping/place_recognition.hpp"
#include "tofmap/mapping/slip_search.hpp"
#include "tofmap/mapping/verification.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace tofmap {
namespace {

/// Largest PlaceDescriptor::difference() of a keyframe that is tried.
constexpr double alike_difference = 0.3;

/// Largest correction by a loop, in standard deviations of drift.
constexpr double most_drift_sigmas = 3;

/// Largest correction by a place that was recognised farther away than ICP reaches. The drift would
/// be larger in one of twenty cases; a slip, or another place that looks the same, is more likely
/// then.
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
  bool can_have_drifted_to(const Pose& pose, const Keyframe& other) const;
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

/// Whether drift explains that the keyframe is at a pose, relative to an earlier one.
bool LoopSearch::can_have_drifted_to(const Pose& pose, const Keyframe& other) const {
  return prior_deviation_sigmas(drift_from(other), pose) <= most_recognised_sigmas;
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
  const auto cloud = keyframe.cloud.load();
  for (const Keyframe* other : earlier) {
    const double share =
        overlap_share(*cloud, keyframe.world_from_camera, target_of(*other), camera, registration);
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
  candidate.registration = register_from_afar(*search.keyframe.cloud.load(), targets, search.camera,
                                              drift, search.registration);
  return candidate;
}

/// Recognises the place that the keyframe sees among keyframes of earlier visits near which the
/// camera may be. Empty if that fails, or if neither drift nor a slip can have led that far.
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
  const auto has_drifted_to = [&](const Recognition& place) {
    return search.can_have_drifted_to(place.registration.world_from_camera,
                                      search.keyframes[static_cast<std::size_t>(place.from)]);
  };
  const auto is_possible = [&](const Keyframe& other, const Pose& pose) {
    return search.can_have_drifted_to(pose, other) ||
           are_near(pose, keyframe.world_from_camera, farthest_slip_m,
                    search.options.max_rotation_rad);
  };
  std::vector<Recognition> places = find_places(keyframe, std::move(earlier), is_possible, before,
                                                search.camera, search.options, search.registration);
  // Drift is the likelier cause: places that only a slip explains count if it explains none.
  const bool needs_slip = std::ranges::none_of(places, has_drifted_to);
  if (!needs_slip) std::erase_if(places, std::not_fn(has_drifted_to));
  const auto found = surest_place(std::move(places), before);
  if (!found) return std::nullopt;
  return LoopCandidate{.from = found->from,
                       .registration = found->registration,
                       .edge = {},
                       .needs_slip = needs_slip};
}

}  // namespace

LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        std::span<const std::optional<PoseSpread>> spreads,
                        const CameraModel& camera, const LoopOptions& options,
                        const RegistrationOptions& registration) {
  const LoopSearch search{keyframe, keyframes, spreads, camera, options, registration};
  const auto earlier = search.candidates();
  LoopCandidate candidate = find_where_believed(search, earlier);
  if (candidate.from < 0 ||
      !confirms_place(
          keyframes[static_cast<std::size_t>(candidate.from)], *keyframe.cloud.load(),
          candidate.registration, camera, options,
          keyframes[static_cast<std::size_t>(candidate.from)].recording == keyframe.recording)) {
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
