// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/free_space.hpp"

#include "keyframe_view.hpp"

#include <vector>

namespace tofmap {
namespace {

/// Number of keyframes that must see through a point after the last one that agrees with it, for it
/// to be gone.
constexpr int views_until_gone = 3;

void add(Observation observation, Sightings& sightings) {
  if (observation == Observation::sees_through) {
    ++sightings.violating;
    ++sightings.violating_since;
  } else if (observation == Observation::agrees) {
    ++sightings.agreeing;
    sightings.violating_since = 0;
  }
}

/// How many points of a cloud a view agrees with, and how many it sees through.
struct Agreement {
  int agreeing = 0;
  int violating = 0;
};

Agreement operator+(const Agreement& a, const Agreement& b) {
  return {a.agreeing + b.agreeing, a.violating + b.violating};
}

Agreement compare(const RegistrationTarget& one, const RegistrationTarget& other,
                  const CameraModel& camera, double margin_m) {
  constexpr std::size_t stride = 3;
  const KeyframeView view(other, camera, margin_m);
  Agreement agreement;
  for (std::size_t i = 0; i < one.cloud->points.size(); i += stride) {
    const SurfacePoint& point = one.cloud->points[i];
    if (!point.has_normal()) continue;
    const Observation observation =
        view.judge(one.world_from_camera * point.getVector3fMap().cast<double>());
    agreement.agreeing += observation == Observation::agrees ? 1 : 0;
    agreement.violating += observation == Observation::sees_through ? 1 : 0;
  }
  return agreement;
}

}  // namespace

bool Sightings::violates_free_space() const {
  return violating > agreeing || violating_since >= views_until_gone;
}

double free_space_violation_share(const RegistrationTarget& one, const RegistrationTarget& other,
                                  const CameraModel& camera, double margin_m) {
  const Agreement sum =
      compare(one, other, camera, margin_m) + compare(other, one, camera, margin_m);
  const int all = sum.agreeing + sum.violating;
  return all > 0 ? static_cast<double>(sum.violating) / all : 0;
}

bool contradicts_free_space(const RegistrationTarget& placed, const RegistrationTarget& target,
                            const CameraModel& camera, double most_share) {
  return free_space_violation_share(placed, target, camera, tolerated_pose_error_m) >= most_share;
}

std::vector<Sightings> sightings_of(const MapCloud& map, std::span<const Keyframe> keyframes,
                                    const CameraModel& camera, double margin_m) {
  std::vector<Sightings> sightings(map.size());
  const auto count = static_cast<std::ptrdiff_t>(map.size());
  // One keyframe after the other, since they may not be in memory together.
  for (const Keyframe& keyframe : keyframes) {
    const RegistrationTarget target = target_of(keyframe);
    const KeyframeView view(target, camera, margin_m);
    const auto recording = static_cast<std::uint32_t>(keyframe.recording);
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (map[at].recording > recording) continue;
      add(view.judge(map[at].getVector3fMap().cast<double>()), sightings[at]);
    }
  }
  return sightings;
}

MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m) {
  const std::vector<Sightings> sightings = sightings_of(map, keyframes, camera, margin_m);
  MapCloud kept;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!sightings[i].violates_free_space()) kept.push_back(map[i]);
  }
  return kept;
}

}  // namespace tofmap
