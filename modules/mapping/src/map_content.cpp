// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_content.hpp"

#include "tofmap/mapping/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace tofmap {
namespace {

/// Whether a frame or keyframe is one of the last recording.
template <class Recorded>
bool is_of_last(const Recorded& recorded, const MapContent& content) {
  return recorded.recording + 1 == static_cast<int>(content.recordings.size());
}

}  // namespace

MapContent::MapContent(const CameraModel& of, const SurfaceMapOptions& options)
    : camera(of), surface_options(options), keyframes(of) {}

Pose pose_of(const RegisteredFrame& frame, const KeyframeGraph& keyframes) {
  return keyframes[frame.keyframe].world_from_camera * frame.keyframe_from_camera;
}

Trajectory trajectory_of(const MapContent& content, int map) {
  Trajectory trajectory;
  for (const RegisteredFrame& frame : content.frames) {
    if (!is_of_last(frame, content) || content.keyframes[frame.keyframe].map != map) continue;
    trajectory.push_back({frame.timestamp_s, pose_of(frame, content.keyframes)});
  }
  return trajectory;
}

std::vector<int> frames_of(const MapContent& content, int map) {
  std::vector<int> indices;
  for (const RegisteredFrame& frame : content.frames) {
    if (!is_of_last(frame, content)) continue;
    if (content.keyframes[frame.keyframe].map == map) indices.push_back(frame.index);
  }
  return indices;
}

Trajectory keyframe_trajectory_of(const MapContent& content, int map) {
  Trajectory trajectory;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (!is_of_last(keyframe, content) || keyframe.map != map) continue;
    trajectory.push_back({keyframe.timestamp_s, keyframe.world_from_camera});
  }
  return trajectory;
}

PoseCertainty least_certain_of(const MapContent& content, int map) {
  std::vector<Pose> poses;
  std::vector<int> index_of(static_cast<std::size_t>(content.keyframes.size()), -1);
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (keyframe.map != map) continue;
    index_of[static_cast<std::size_t>(keyframe.id)] = static_cast<int>(poses.size());
    poses.push_back(keyframe.world_from_camera);
  }
  std::vector<PoseEdge> edges;
  auto loop = content.loops.begin();
  for (const PoseEdge& edge : content.edges) {
    const bool is_used = !edge.may_be_wrong || loop++->is_used;
    if (!is_used || content.keyframes[edge.from].map != map ||
        content.keyframes[edge.to].map != map)
      continue;
    edges.push_back(edge);
    edges.back().from = index_of[static_cast<std::size_t>(edge.from)];
    edges.back().to = index_of[static_cast<std::size_t>(edge.to)];
  }
  const std::vector<ExpectedError> errors = expected_errors(poses, edges);
  PoseCertainty least{.frame = -1, .error = {}};
  for (const RegisteredFrame& frame : content.frames) {
    if (!is_of_last(frame, content) || content.keyframes[frame.keyframe].map != map) continue;
    const int index = index_of[static_cast<std::size_t>(frame.keyframe)];
    ExpectedError error = errors[static_cast<std::size_t>(index)];
    error.position_m = std::hypot(error.position_m, frame.sigma_m);
    if (least.frame < 0 || error.position_m > least.error.position_m) least = {frame.index, error};
  }
  return least;
}

std::size_t voxel_count(const MapContent& content) {
  std::size_t count = 0;
  for (const Submap& submap : content.submaps) count += submap.surface.size();
  return count;
}

MapCloud surface_of(const MapContent& content, int map) {
  SurfaceMap whole(content.surface_options);
  for (const Submap& submap : content.submaps) {
    const Keyframe& anchor = content.keyframes[submap.anchor];
    if (anchor.map == map) whole.add(submap.surface, anchor.world_from_camera);
  }
  MapCloud surface = whole.extract();
  if (!content.surface_options.drop_free_space_violations) return surface;
  std::vector<Keyframe> seen_by;
  std::ranges::copy_if(content.keyframes.all(), std::back_inserter(seen_by),
                       [&](const Keyframe& keyframe) { return keyframe.map == map; });
  return without_free_space_violations(surface, seen_by, content.camera,
                                       content.surface_options.voxel_m);
}

std::vector<int> maps_of(const MapContent& content) {
  std::map<int, int> counts;
  for (const RegisteredFrame& frame : content.frames) {
    if (is_of_last(frame, content)) ++counts[content.keyframes[frame.keyframe].map];
  }
  std::set<int> extended;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (!is_of_last(keyframe, content)) extended.insert(keyframe.map);
  }
  std::vector<int> maps;
  for (const auto& [map, frames] : counts) maps.push_back(map);
  std::ranges::stable_sort(maps, std::ranges::greater(),
                           [&](int map) { return std::pair(extended.contains(map), counts[map]); });
  return maps;
}

}  // namespace tofmap
