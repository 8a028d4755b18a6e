// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "views/map_details.hpp"

#include "output/change_drawing.hpp"

#include <utility>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
MapDetails::MapDetails(MapContent content)
    : content_(std::move(content)), map_(largest_map(content_)) {}

void MapDetails::step(int step) {
  const int count = content_.keyframes.size();
  for (int tried = 0; tried < count; ++tried) {
    shown_ = shown_ < 0 ? (step > 0 ? 0 : count - 1) : (shown_ + step + count) % count;
    if (content_.keyframes[shown_].map == map_) return;
  }
}

void MapDetails::show(int id) {
  if (id < 0 || id >= content_.keyframes.size() || content_.keyframes[id].map != map_) {
    throw UsageError(fmt::format("the map has no keyframe {}; it has {}, counted from 0", id,
                                 content_.keyframes.size()));
  }
  shown_ = id;
}

void MapDetails::add_keyframe(Drawing& drawing, const Pose& drawing_from_world) const {
  if (shown_ < 0) return;
  const Keyframe& keyframe = content_.keyframes[shown_];
  const Pose drawing_from_camera = drawing_from_world * keyframe.world_from_camera;
  const Eigen::Affine3f transform = drawing_from_camera.cast<float>();
  PointLayer layer;
  const auto cloud = keyframe.cloud.load();
  for (const SurfacePoint& point : cloud->points) {
    if (!point.has_position()) continue;
    layer.points_m.emplace_back(transform * Eigen::Vector3f(point.getVector3fMap()));
    layer.colors.push_back(colors::path);
  }
  drawing.points.push_back(std::move(layer));
  drawing.lines.push_back(camera_outline(drawing_from_camera));
}

void MapDetails::add_changes(Drawing& drawing, const Pose& drawing_from_world) const {
  for (const MapChange& change : content_.changes) {
    if (change.map == map_) add_change(drawing, change, drawing_from_world);
  }
}

std::string MapDetails::status() const {
  if (shown_ < 0) return {};
  const Keyframe& keyframe = content_.keyframes[shown_];
  const MapRecording& recording = content_.recordings[static_cast<std::size_t>(keyframe.recording)];
  return fmt::format("keyframe {} of {}: frame {} of {}, {}", shown_, content_.keyframes.size(),
                     keyframe.frame_index, recording.source, recording.added);
}

}  // namespace tofmap::app
