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

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Whether a frame or keyframe is one of the last recording.
template <class Recorded>
bool is_of_last(const Recorded& recorded, const MapContent& content) {
  return recorded.recording + 1 == static_cast<int>(content.recordings.size());
}

/// The numbers of the maps that have keyframes of earlier recordings.
std::set<int> earlier_maps(const MapContent& content) {
  std::set<int> maps;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (!is_of_last(keyframe, content)) maps.insert(keyframe.map);
  }
  return maps;
}

/// The first keyframe of each recording that has one.
std::map<int, const Keyframe*> first_keyframes(const MapContent& content) {
  std::map<int, const Keyframe*> firsts;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    firsts.emplace(keyframe.recording, &keyframe);
  }
  return firsts;
}

bool are_of_one_frame(const Keyframe& one, const Keyframe& other) {
  return one.frame_index == other.frame_index && one.place.difference(other.place) == 0;
}

/// The pose graph of one map.
struct MapGraph {
  MapGraph(const MapContent& content, int map)
      : indices(static_cast<std::size_t>(content.keyframes.size())) {
    for (const Keyframe& keyframe : content.keyframes.all()) {
      if (keyframe.map != map) continue;
      indices[static_cast<std::size_t>(keyframe.id)] = poses.size();
      poses.push_back(keyframe.world_from_camera);
      earlier += is_of_last(keyframe, content) ? 0 : 1;
    }
    auto loop = content.loops.begin();
    for (const PoseEdge& edge : content.edges) {
      const bool is_used = !edge.may_be_wrong || loop++->is_used;
      if (!is_used || content.keyframes[edge.from].map != map ||
          content.keyframes[edge.to].map != map) {
        continue;
      }
      edges.push_back(edge);
      edges.back().from = static_cast<int>(index_of(edge.from));
      edges.back().to = static_cast<int>(index_of(edge.to));
    }
  }

  /// The index of a keyframe of the map among `poses`.
  std::size_t index_of(int keyframe) const { return indices[static_cast<std::size_t>(keyframe)]; }

  std::vector<std::size_t> indices;  ///< for each keyframe
  std::vector<Pose> poses;           ///< of the keyframes of the map
  std::size_t earlier = 0;           ///< number of those of earlier recordings, which come first
  std::vector<PoseEdge> edges;       ///< without loops that are not used
};

}  // namespace

MapContent::MapContent(const CameraModel& of, const SurfaceMapOptions& options)
    : camera(of), surface_options(options), keyframes(of) {}

bool are_same_camera(const CameraModel& one, const CameraModel& other) {
  const auto is_same = [](double a, double b) {
    constexpr double tolerance = 0.001;
    return std::abs(a - b) <= tolerance * std::max(std::abs(a), 1.0);
  };
  return one.width_px == other.width_px && one.height_px == other.height_px &&
         is_same(one.fx_px, other.fx_px) && is_same(one.fy_px, other.fy_px) &&
         is_same(one.cx_px, other.cx_px) && is_same(one.cy_px, other.cy_px) &&
         std::ranges::equal(one.distortion, other.distortion, is_same);
}

int largest_map(const MapContent& content) {
  std::map<int, int> counts;
  for (const Keyframe& keyframe : content.keyframes.all()) ++counts[keyframe.map];
  const auto largest =
      std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  return largest == counts.end() ? 0 : largest->first;
}

std::optional<std::size_t> latest_submap(const MapContent& content) {
  if (content.frames.empty()) return std::nullopt;
  const auto keyframe = static_cast<std::size_t>(content.frames.back().keyframe);
  return static_cast<std::size_t>(content.submap_of[keyframe]);
}

std::vector<int> submaps_at_rest(const MapContent& content) {
  const auto latest = latest_submap(content);
  std::vector<int> indices;
  for (std::size_t i = 0; i < content.submaps.size(); ++i) {
    const bool is_in_memory = !content.submaps[i].surface.is_aside();
    if (i != latest && is_in_memory) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

Pose pose_of(const RegisteredFrame& frame, const KeyframeGraph& keyframes) {
  return keyframes[frame.keyframe].world_from_camera * frame.keyframe_from_camera;
}

Trajectory trajectory_of(const MapContent& content, int map, int recording) {
  Trajectory trajectory;
  for (const RegisteredFrame& frame : content.frames) {
    if (frame.recording != recording || content.keyframes[frame.keyframe].map != map) continue;
    trajectory.push_back({frame.timestamp_s, pose_of(frame, content.keyframes)});
  }
  return trajectory;
}

Trajectory trajectory_of(const MapContent& content, int map) {
  return trajectory_of(content, map, static_cast<int>(content.recordings.size()) - 1);
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

Trajectory all_keyframes_of(const MapContent& content, int map) {
  Trajectory trajectory;
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (keyframe.map != map) continue;
    trajectory.push_back({keyframe.timestamp_s, keyframe.world_from_camera});
  }
  return trajectory;
}

std::vector<PoseCertainty> certainties_of(const MapContent& content, int map) {
  const MapGraph graph(content, map);
  const std::vector<ExpectedError> errors = expected_errors(graph.poses, graph.edges);
  std::vector<PoseCertainty> frames;
  for (const RegisteredFrame& frame : content.frames) {
    if (!is_of_last(frame, content) || content.keyframes[frame.keyframe].map != map) continue;
    ExpectedError error = errors[graph.index_of(frame.keyframe)];
    error.position_m =
        std::hypot(error.position_m, spread_of(frame.covariance).translation_sigma_m());
    frames.push_back({frame.index, error});
  }
  return frames;
}

PoseCertainty least_certain(std::span<const PoseCertainty> frames) {
  return *std::ranges::max_element(
      frames, {}, [](const PoseCertainty& frame) { return frame.error.position_m; });
}

std::vector<Matrix6d> covariances_of(const MapContent& content, int map) {
  const MapGraph graph(content, map);
  const bool is_first = content.recordings.size() == 1;
  const std::size_t held = is_first ? 1 : graph.earlier;
  const std::vector<Matrix6d> of_keyframes = covariances_beside(graph.poses, graph.edges, held);
  std::vector<Matrix6d> covariances;
  for (const RegisteredFrame& frame : content.frames) {
    const Keyframe& keyframe = content.keyframes[frame.keyframe];
    if (!is_of_last(frame, content) || keyframe.map != map) continue;
    Matrix6d covariance = rotated(frame.covariance, keyframe.world_from_camera.linear());
    const std::size_t index = graph.index_of(frame.keyframe);
    if (index >= held) {
      // An error of the keyframe moves the frame with it, and its rotation swings the frame around.
      const Eigen::Vector3d arm_m =
          keyframe.world_from_camera.linear() * frame.keyframe_from_camera.translation();
      const Matrix6d moved = twist_at_offset(arm_m);
      covariance += moved * of_keyframes[index - held] * moved.transpose();
    }
    covariances.push_back(covariance);
  }
  return covariances;
}

std::size_t voxel_count(const MapContent& content) {
  std::size_t count = 0;
  for (const Submap& submap : content.submaps) count += submap.surface.size();
  return count;
}

MapCloud merged_submaps(const MapContent& content,
                        const std::function<bool(const Keyframe& anchor)>& is_wanted) {
  SurfaceMap whole(content.surface_options);
  for (const Submap& submap : content.submaps) {
    const Keyframe& anchor = content.keyframes[submap.anchor];
    if (is_wanted(anchor)) {
      whole.add(*submap.surface.load(), anchor.world_from_camera, anchor.recording);
    }
  }
  return whole.extract();
}

MapCloud surface_of(const MapContent& content, int map) {
  const auto is_of_map = [&](const Keyframe& keyframe) { return keyframe.map == map; };
  MapCloud surface = merged_submaps(content, is_of_map);
  if (!content.surface_options.drop_free_space_violations) return surface;
  std::vector<Keyframe> seen_by;
  std::ranges::copy_if(content.keyframes.all(), std::back_inserter(seen_by), is_of_map);
  std::ranges::stable_sort(seen_by, {}, &Keyframe::recording);
  return without_free_space_violations(surface, seen_by, content.camera,
                                       content.surface_options.voxel_m);
}

bool have_one_recording(const MapContent& one, const MapContent& other) {
  const auto firsts = first_keyframes(other);
  return std::ranges::any_of(first_keyframes(one), [&](const auto& first) {
    return std::ranges::any_of(firsts, [&](const auto& of_other) {
      return are_of_one_frame(*first.second, *of_other.second);
    });
  });
}

std::optional<int> repeated_recording(const MapContent& content) {
  const auto firsts = first_keyframes(content);
  const auto last = firsts.find(static_cast<int>(content.recordings.size()) - 1);
  if (last == firsts.end()) return std::nullopt;
  const auto repeated = std::find_if(firsts.begin(), last, [&](const auto& first) {
    return are_of_one_frame(*first.second, *last->second);
  });
  return repeated == last ? std::nullopt : std::optional(repeated->first);
}

std::vector<const RegisteredFrame*> localised_frames_of(const MapContent& content) {
  const std::set<int> earlier = earlier_maps(content);
  std::vector<const RegisteredFrame*> localised;
  for (const RegisteredFrame& frame : content.frames) {
    if (is_of_last(frame, content) && earlier.contains(content.keyframes[frame.keyframe].map)) {
      localised.push_back(&frame);
    }
  }
  return localised;
}

std::vector<int> maps_of(const MapContent& content) {
  std::map<int, int> counts;
  for (const RegisteredFrame& frame : content.frames) {
    if (is_of_last(frame, content)) ++counts[content.keyframes[frame.keyframe].map];
  }
  const std::set<int> extended = earlier_maps(content);
  std::vector<int> maps;
  for (const auto& [map, frames] : counts) maps.push_back(map);
  std::ranges::stable_sort(maps, std::ranges::greater(),
                           [&](int map) { return std::pair(extended.contains(map), counts[map]); });
  return maps;
}

}  // namespace tofmap
