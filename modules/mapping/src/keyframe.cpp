// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe.hpp"

#include <algorithm>
#include <utility>

namespace tofmap {

RegistrationTarget target_of(const Keyframe& keyframe) {
  auto cloud = keyframe.cloud.load();
  const SurfaceCloud* seen = cloud.get();
  return {seen, keyframe.world_from_camera, std::move(cloud)};
}

std::vector<RegistrationTarget> targets_around(const Keyframe& keyframe,
                                               std::span<const Keyframe> keyframes) {
  std::vector<RegistrationTarget> targets{target_of(keyframe)};
  for (const int id : {keyframe.id - 1, keyframe.id + 1}) {
    if (id < 0 || id >= static_cast<int>(keyframes.size())) continue;
    const Keyframe& other = keyframes[static_cast<std::size_t>(id)];
    if (other.map == keyframe.map) targets.push_back(target_of(other));
  }
  return targets;
}

std::vector<const Keyframe*> most_alike(const PlaceDescriptor& place,
                                        std::vector<const Keyframe*> keyframes, std::size_t most) {
  std::ranges::stable_sort(
      keyframes, {}, [&](const Keyframe* keyframe) { return place.difference(keyframe->place); });
  keyframes.resize(std::min(keyframes.size(), most));
  return keyframes;
}

}  // namespace tofmap
