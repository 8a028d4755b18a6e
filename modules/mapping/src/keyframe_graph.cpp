// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_graph.hpp"

#include <algorithm>

namespace tofmap {
namespace {

/// Largest number of registrations between two keyframes. The error of their relative pose grows
/// with that number; over five it is still small.
constexpr int max_hops = 5;

}  // namespace

double KeyframeSpacing::between(const Pose& a, const Pose& b) const {
  return std::max((a.translation() - b.translation()).norm() / step_m,
                  rotation_angle_rad(a, b) / rotation_rad);
}

void KeyframeGraph::add(Keyframe keyframe) {
  keyframes_.push_back(std::move(keyframe));
  neighbours_.emplace_back();
}

void KeyframeGraph::connect(int a, int b) {
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
    std::vector<int>& connected = neighbours_[static_cast<std::size_t>(one)];
    if (std::ranges::find(connected, other) == connected.end()) connected.push_back(other);
  }
}

void KeyframeGraph::set_pose(int id, const Pose& world_from_camera) {
  keyframes_[static_cast<std::size_t>(id)].world_from_camera = world_from_camera;
}

void KeyframeGraph::set_cloud(int id, std::shared_ptr<const SurfaceCloud> cloud) {
  Keyframe& keyframe = keyframes_[static_cast<std::size_t>(id)];
  keyframe.place = PlaceDescriptor(*cloud);
  keyframe.cloud = std::move(cloud);
}

void KeyframeGraph::join(int map, int into, const Pose& into_from_map) {
  for (Keyframe& keyframe : keyframes_) {
    if (keyframe.map != map) continue;
    keyframe.map = into;
    keyframe.world_from_camera = into_from_map * keyframe.world_from_camera;
  }
}

void KeyframeGraph::shrink(int size) {
  keyframes_.resize(static_cast<std::size_t>(size));
  neighbours_.resize(static_cast<std::size_t>(size));
}

std::vector<const Keyframe*> KeyframeGraph::around(int id, const Pose& pose, int count,
                                                   const KeyframeSpacing& steps) const {
  const auto steps_away = [&](int other) {
    return steps.between((*this)[other].world_from_camera, pose);
  };
  std::vector<int> ids = within_reach(id);
  // Of keyframes at equal distance, the most recent ones are taken.
  std::ranges::sort(ids, std::ranges::greater());
  std::ranges::stable_sort(ids, std::ranges::less(), steps_away);
  if (static_cast<int>(ids.size()) > count - 1) ids.resize(static_cast<std::size_t>(count - 1));
  std::ranges::sort(ids);
  ids.push_back(id);
  std::vector<const Keyframe*> keyframes;
  for (const int other : ids) keyframes.push_back(&(*this)[other]);
  return keyframes;
}

std::vector<int> KeyframeGraph::within_reach(int id) const {
  std::vector<int> reached{id};
  std::size_t border = 0;
  for (int hops = 0; hops < max_hops; ++hops) {
    const std::size_t end = reached.size();
    for (; border < end; ++border) {
      for (const int other : neighbours_[static_cast<std::size_t>(reached[border])]) {
        if (std::ranges::find(reached, other) == reached.end()) reached.push_back(other);
      }
    }
  }
  reached.erase(reached.begin());
  return reached;
}

}  // namespace tofmap
