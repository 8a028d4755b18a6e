// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_graph.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

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

void KeyframeGraph::connect(int a, int b, const PoseSpread& spread) {
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
    std::vector<Neighbour>& connected = neighbours_[static_cast<std::size_t>(one)];
    const auto known = std::ranges::find(connected, other, &Neighbour::id);
    if (known == connected.end()) {
      connected.push_back({other, spread});
    } else if (spread.translation_m2 < known->spread.translation_m2) {
      known->spread = spread;
    }
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

void KeyframeGraph::assign_maps(std::span<const int> map_of) {
  for (Keyframe& keyframe : keyframes_) {
    keyframe.map = map_of[static_cast<std::size_t>(keyframe.taken_in)];
  }
  for (const Keyframe& keyframe : keyframes_) {
    std::erase_if(neighbours_[static_cast<std::size_t>(keyframe.id)],
                  [&](const Neighbour& other) { return (*this)[other.id].map != keyframe.map; });
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
  std::vector<int> ids = well_connected_to(id);
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

std::vector<int> KeyframeGraph::well_connected_to(int id) const {
  std::map<int, double> reached_m2{{id, 0.0}};  // the variance along the connections so far
  std::map<int, double> border_m2 = reached_m2;
  for (int hops = 0; hops < max_hops; ++hops) {
    std::map<int, double> next_m2;
    for (const auto& [from, variance_m2] : border_m2) {
      for (const Neighbour& neighbour : neighbours_[static_cast<std::size_t>(from)]) {
        const double sum_m2 = variance_m2 + neighbour.spread.translation_m2;
        if (sum_m2 > well_connected_sigma_m * well_connected_sigma_m) continue;
        const auto [known, is_new] = reached_m2.try_emplace(neighbour.id, sum_m2);
        if (!is_new && known->second <= sum_m2) continue;
        known->second = sum_m2;
        next_m2[neighbour.id] = sum_m2;
      }
    }
    border_m2 = std::move(next_m2);
  }
  std::vector<int> found;
  for (const auto& [other, variance_m2] : reached_m2) {
    if (other != id) found.push_back(other);
  }
  return found;
}

std::vector<std::optional<PoseSpread>> KeyframeGraph::spreads_from(int id) const {
  std::vector<std::optional<PoseSpread>> spreads(keyframes_.size());
  const auto is_farther = [](const Neighbour& one, const Neighbour& other) {
    return one.spread.translation_m2 > other.spread.translation_m2;
  };
  std::priority_queue<Neighbour, std::vector<Neighbour>, decltype(is_farther)> open(is_farther);
  open.push({id, {}});
  while (!open.empty()) {
    const Neighbour nearest = open.top();
    open.pop();
    std::optional<PoseSpread>& spread = spreads[static_cast<std::size_t>(nearest.id)];
    if (spread) continue;
    spread = nearest.spread;
    for (const Neighbour& next : neighbours_[static_cast<std::size_t>(nearest.id)]) {
      if (!spreads[static_cast<std::size_t>(next.id)]) {
        open.push({next.id, nearest.spread + next.spread});
      }
    }
  }
  return spreads;
}

void KeyframeGraph::reconnect() {
  constexpr double well_connected_m2 = well_connected_sigma_m * well_connected_sigma_m;
  const auto is_loose = [](const Neighbour& neighbour) {
    return neighbour.spread.translation_m2 > well_connected_m2;
  };
  for (int id = 0; id < size(); ++id) {
    const std::vector<Neighbour> neighbours = neighbours_[static_cast<std::size_t>(id)];
    if (std::ranges::none_of(neighbours, is_loose)) continue;
    const auto spreads = spreads_from(id);
    for (const Neighbour& neighbour : neighbours) {
      const std::optional<PoseSpread>& spread = spreads[static_cast<std::size_t>(neighbour.id)];
      if (spread && spread->translation_m2 <= well_connected_m2) connect(id, neighbour.id, *spread);
    }
  }
}

}  // namespace tofmap
