// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "seen_surface.hpp"

#include "tofmap/mapping/free_space.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>

namespace tofmap {
namespace {

/// How many times more keyframes must agree with a surface than see through it, for it to have been
/// there: edges of things, and ranges between two surfaces, are seen by some and not by others.
constexpr int times_surer = 3;

/// How much of a surface a pixel covers at most for a keyframe to show it with certainty. A pixel
/// that covers more, far away or at a grazing angle, mixes things.
constexpr float most_covered_m = 0.15F;

/// For each point, how much of its surface a pixel covers in the two keyframes that show it best,
/// the best first, occlusion aside. Infinite if there are fewer.
std::vector<std::array<float, 2>> least_covered(const MapCloud& points,
                                                std::span<const Keyframe> keyframes,
                                                const CameraModel& camera) {
  constexpr float unseen_m = std::numeric_limits<float>::infinity();
  std::vector<std::array<float, 2>> least_m(points.size(), {unseen_m, unseen_m});
  for (const Keyframe& keyframe : keyframes) {
    const Pose camera_from_world = keyframe.world_from_camera.inverse();
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t at = 0; at < std::ssize(points); ++at) {
      const auto i = static_cast<std::size_t>(at);
      const Eigen::Vector3d point_m = camera_from_world * points[i].getVector3fMap().cast<double>();
      const Eigen::Vector3d normal =
          camera_from_world.linear() * points[i].getNormalVector3fMap().cast<double>();
      const double cosine = -normal.dot(point_m.normalized());
      if (point_m.z() <= 0 || cosine <= 0) continue;
      const auto pixel = project(camera, point_m);
      const bool is_in_view = pixel && pixel->x() >= 0 && pixel->y() >= 0 &&
                              pixel->x() < camera.width_px && pixel->y() < camera.height_px;
      if (!is_in_view) continue;
      auto& [best_m, second_m] = least_m[i];
      const auto covered_m = static_cast<float>(point_m.norm() / (camera.fx_px * cosine));
      second_m = std::min(second_m, std::max(best_m, covered_m));
      best_m = std::min(best_m, covered_m);
    }
  }
  return least_m;
}

}  // namespace

SeenSurface surface_seen(const MapContent& content, int map, int first, int end) {
  SeenSurface seen;
  const auto is_seen = [&](const Keyframe& keyframe) {
    return keyframe.map == map && keyframe.recording >= first && keyframe.recording < end;
  };
  std::ranges::copy_if(content.keyframes.all(), std::back_inserter(seen.keyframes), is_seen);
  std::ranges::stable_sort(seen.keyframes, {}, &Keyframe::recording);
  const MapCloud points = merged_submaps(content, is_seen);
  const std::vector<Sightings> sightings =
      sightings_of(points, seen.keyframes, content.camera, content.surface_options.voxel_m);
  const auto covered_m = least_covered(points, seen.keyframes, content.camera);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [violating, agreeing, since] = sightings[i];
    if (sightings[i].violates_free_space()) continue;
    seen.points.push_back(points[i]);
    const auto [best_m, second_m] = covered_m[i];
    const bool is_sure = second_m <= most_covered_m && agreeing >= least_views &&
                         agreeing >= times_surer * violating;
    const bool is_possible = best_m <= 2 * most_covered_m;
    seen.certainty.push_back(is_sure       ? Certainty::sure
                             : is_possible ? Certainty::possible
                                           : Certainty::none);
  }
  return seen;
}

}  // namespace tofmap
