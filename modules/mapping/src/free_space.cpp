// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/free_space.hpp"

#include "keyframe_view.hpp"

#include <vector>

namespace tofmap {
namespace {

/// Number of keyframes that must see through a point after the last one that agrees with it, for it
/// to be gone. One or two may be deceived.
constexpr int views_until_gone = 3;

/// `views` are in the order of time.
bool violates_free_space(const MapPoint& point, const std::vector<KeyframeView>& views) {
  int free_space_violation = 0;
  int agreeing = 0;
  int seen_through_since = 0;
  for (const KeyframeView& view : views) {
    const Observation observation = view.judge(point.getVector3fMap().cast<double>());
    if (observation == Observation::sees_through) {
      ++free_space_violation;
      ++seen_through_since;
    } else if (observation == Observation::agrees) {
      ++agreeing;
      seen_through_since = 0;
    }
  }
  return free_space_violation > agreeing || seen_through_since >= views_until_gone;
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

double free_space_violation_share(const RegistrationTarget& one, const RegistrationTarget& other,
                                  const CameraModel& camera, double margin_m) {
  const Agreement sum =
      compare(one, other, camera, margin_m) + compare(other, one, camera, margin_m);
  const int all = sum.agreeing + sum.violating;
  return all > 0 ? static_cast<double>(sum.violating) / all : 0;
}

bool contradicts_free_space(const RegistrationTarget& placed, const RegistrationTarget& target,
                            const CameraModel& camera) {
  constexpr double most_violations = 0.05;
  constexpr double pose_error_m = 0.03;
  return free_space_violation_share(placed, target, camera, pose_error_m) >= most_violations;
}

MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m) {
  std::vector<KeyframeView> views;
  for (const Keyframe& keyframe : keyframes) {
    views.emplace_back(target_of(keyframe), camera, margin_m);
  }
  std::vector<char> goes(map.size());
  const auto count = static_cast<std::ptrdiff_t>(map.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    goes[static_cast<std::size_t>(i)] =
        violates_free_space(map[static_cast<std::size_t>(i)], views) ? 1 : 0;
  }
  MapCloud kept;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (goes[i] == 0) kept.push_back(map[i]);
  }
  return kept;
}

}  // namespace tofmap
