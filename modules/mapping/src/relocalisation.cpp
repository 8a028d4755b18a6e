// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/relocalisation.hpp"

#include <algorithm>
#include <vector>

namespace tofmap {
namespace {

/// Share of the cloud's points that fit the surfaces of a place.
double support(const Relocalisation& place) {
  return place.registration.overlap * place.registration.inlier_ratio;
}

/// The best place is ambiguous if another place has more than this share of its support.
constexpr double sure_share = 0.9;

bool is_same_place(const Relocalisation& one, const Relocalisation& other) {
  const Pose& pose = one.registration.world_from_camera;
  const Pose& other_pose = other.registration.world_from_camera;
  return (pose.translation() - other_pose.translation()).norm() < recognition_reach_m / 2 &&
         rotation_angle_rad(pose, other_pose) < recognition_reach_rad / 2;
}

}  // namespace

std::optional<Relocalisation> relocalise(const SurfaceCloud& cloud,
                                         std::span<const Keyframe> keyframes,
                                         const CameraModel& camera, const LoopOptions& options,
                                         const RegistrationOptions& registration) {
  constexpr std::size_t most_candidates = 5;
  std::vector<const Keyframe*> all;
  for (const Keyframe& keyframe : keyframes) all.push_back(&keyframe);
  std::vector<Relocalisation> found;
  for (const Keyframe* keyframe :
       most_alike(PlaceDescriptor(cloud), std::move(all), most_candidates)) {
    const RegistrationResult result =
        register_near(*keyframe, cloud, keyframes, camera, registration);
    if (is_verified(result, options)) found.push_back({keyframe->id, result});
  }
  if (found.empty()) return std::nullopt;
  std::ranges::stable_sort(found, std::ranges::greater(), support);
  const Relocalisation& best = found.front();
  const bool is_ambiguous = std::ranges::any_of(found, [&](const Relocalisation& other) {
    return support(other) > sure_share * support(best) && !is_same_place(best, other);
  });
  return is_ambiguous ? std::nullopt : std::optional(best);
}

}  // namespace tofmap
