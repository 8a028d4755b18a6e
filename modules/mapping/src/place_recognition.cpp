// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/place_recognition.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/verification.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tofmap {
namespace {

constexpr std::size_t most_candidates = 5;

/// The best place is ambiguous if another place has more than this share of its support.
constexpr double sure_share = 0.9;

double support_of(const Recognition& place) { return support(place.registration); }

bool is_same_place(const Recognition& one, const Recognition& other,
                   std::span<const Keyframe> keyframes) {
  const auto map_of = [&](const Recognition& place) {
    return keyframes[static_cast<std::size_t>(place.from)].map;
  };
  return map_of(one) == map_of(other) &&
         are_near(one.registration.world_from_camera, other.registration.world_from_camera,
                  recognition_reach_m / 2, recognition_reach_rad / 2);
}

/// The keyframes that look most similar. Those of other recordings are followed by as many at other
/// places: where nothing tells how the camera came, all places that look alike must be known.
std::vector<const Keyframe*> likely_places(const Keyframe& keyframe,
                                           std::vector<const Keyframe*> candidates) {
  const std::size_t count = candidates.size();
  const std::vector<const Keyframe*> alike =
      most_alike(keyframe.place, std::move(candidates), count);
  std::vector<const Keyframe*> likely(
      alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(std::min(count, most_candidates)));
  for (const Keyframe* candidate : alike) {
    if (likely.size() >= 2 * most_candidates) break;
    if (candidate->recording == keyframe.recording) continue;
    const bool is_elsewhere = std::ranges::none_of(likely, [&](const Keyframe* other) {
      return other->map == candidate->map &&
             are_near(other->world_from_camera, candidate->world_from_camera,
                      2 * recognition_reach_m, 2 * recognition_reach_rad);
    });
    if (is_elsewhere) likely.push_back(candidate);
  }
  return likely;
}

}  // namespace

RegistrationResult register_near(const Keyframe& keyframe, const SurfaceCloud& cloud,
                                 std::span<const Keyframe> keyframes, const CameraModel& camera,
                                 const RegistrationOptions& registration) {
  const MotionPrior prior{.world_from_camera = keyframe.world_from_camera,
                          .rotation_sigma_rad = recognition_reach_rad,
                          .translation_sigma_m = recognition_reach_m};
  return register_from_afar(cloud, targets_around(keyframe, keyframes), camera, prior,
                            registration);
}

std::vector<Recognition> find_places(const Keyframe& keyframe,
                                     std::vector<const Keyframe*> candidates,
                                     const IsPossiblePlace& is_possible,
                                     std::span<const Keyframe> keyframes, const CameraModel& camera,
                                     const LoopOptions& options,
                                     const RegistrationOptions& registration) {
  std::vector<Recognition> found;
  const auto cloud = keyframe.cloud.load();
  for (const Keyframe* candidate : likely_places(keyframe, std::move(candidates))) {
    const RegistrationResult result =
        register_near(*candidate, *cloud, keyframes, camera, registration);
    if (is_possible(*candidate, result.world_from_camera) &&
        confirms_place(*candidate, *cloud, result, camera, options,
                       candidate->recording == keyframe.recording)) {
      found.push_back({candidate->id, result});
    }
  }
  return found;
}

std::optional<Recognition> surest_place(std::vector<Recognition> places,
                                        std::span<const Keyframe> keyframes) {
  if (places.empty()) return std::nullopt;
  std::ranges::stable_sort(places, std::ranges::greater(), support_of);
  const Recognition& best = places.front();
  const bool is_ambiguous = std::ranges::any_of(places, [&](const Recognition& other) {
    return support_of(other) > sure_share * support_of(best) &&
           !is_same_place(best, other, keyframes);
  });
  return is_ambiguous ? std::nullopt : std::optional(best);
}

RecognisedPlaces recognise_places(const Keyframe& keyframe, std::vector<const Keyframe*> candidates,
                                  const IsPossiblePlace& is_possible,
                                  std::span<const Keyframe> keyframes, const CameraModel& camera,
                                  const LoopOptions& options,
                                  const RegistrationOptions& registration) {
  const auto edge_of = [&](const Recognition& place) {
    return loop_edge(keyframes[static_cast<std::size_t>(place.from)], keyframe.id,
                     place.registration);
  };
  std::vector<Recognition> places = find_places(keyframe, std::move(candidates), is_possible,
                                                keyframes, camera, options, registration);
  RecognisedPlaces recognised;
  std::ranges::transform(places, std::back_inserter(recognised.possible), edge_of);
  if (const auto surest = surest_place(std::move(places), keyframes)) {
    recognised.surest = edge_of(*surest);
  }
  return recognised;
}

}  // namespace tofmap
