// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/contradicted_loops.hpp"

#include "near_points.hpp"

#include <algorithm>
#include <utility>

namespace tofmap {
namespace {

/// What has changed in a map between two recordings: before and after.
MapCloud changed_surface(const MapContent& content, int map, int earlier, int later) {
  MapCloud surface;
  for (const MapChange& change : content.changes) {
    if (change.map != map || change.recording <= earlier || change.recording > later) continue;
    for (const MapPoint& point : change.before) surface.push_back(point);
    for (const MapPoint& point : change.after) surface.push_back(point);
  }
  return surface;
}

/// Share of the surface of a keyframe that is near points of the world.
double share_near(const Keyframe& keyframe, const NearPoints& points) {
  int all = 0;
  int near = 0;
  const auto cloud = keyframe.cloud.load();
  for (const SurfacePoint& point : cloud->points) {
    if (!point.has_normal()) continue;
    MapPoint in_world;
    in_world.getVector3fMap() =
        (keyframe.world_from_camera * point.getVector3fMap().cast<double>()).cast<float>();
    ++all;
    near += points.any_near(in_world, [](std::size_t) { return true; }) ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(near) / all : 0;
}

bool is_explained(const PoseEdge& loop, const MapContent& content) {
  constexpr double least_share = 0.05;
  constexpr double reach_voxels = 2;
  const Keyframe& from = content.keyframes[loop.from];
  const Keyframe& to = content.keyframes[loop.to];
  const auto [earlier, later] = std::minmax(from.recording, to.recording);
  const MapCloud changed = changed_surface(content, from.map, earlier, later);
  if (changed.empty()) return false;
  const NearPoints near(changed,
                        static_cast<float>(reach_voxels * content.surface_options.voxel_m));
  return std::max(share_near(from, near), share_near(to, near)) >= least_share;
}

}  // namespace

int contradicted_loops(const MapContent& content) {
  int rejected = 0;
  int explained = 0;
  int used_between_recordings = 0;
  int rejected_between_recordings = 0;
  auto loop = content.loops.begin();
  for (const PoseEdge& edge : content.edges) {
    if (!edge.may_be_wrong) continue;
    const bool is_used = (loop++)->is_used;
    const bool is_between_recordings =
        content.keyframes[edge.from].recording != content.keyframes[edge.to].recording;
    (is_used ? used_between_recordings : rejected_between_recordings) +=
        is_between_recordings ? 1 : 0;
    rejected += is_used ? 0 : 1;
    explained += !is_used && is_between_recordings && is_explained(edge, content) ? 1 : 0;
  }
  return rejected_between_recordings < used_between_recordings ? rejected - explained : rejected;
}

}  // namespace tofmap
