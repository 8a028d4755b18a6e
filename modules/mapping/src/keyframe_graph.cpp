// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_graph.hpp"

#include <algorithm>
#include <limits>
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

/// The cloud as the graph keeps it.
KeyframeCloud KeyframeGraph::kept(const KeyframeCloud& cloud) {
  return shelf_ && !cloud.is_on_shelf() ? shelf_->add(*cloud.load()) : cloud;
}

void KeyframeGraph::add(Keyframe keyframe) {
  keyframe.cloud = kept(keyframe.cloud);
  keyframes_.push_back(std::move(keyframe));
  links_.emplace_back();
}

void KeyframeGraph::add(Keyframe keyframe, std::function<CompactCloud()> read_cloud) {
  keyframe.cloud = shelf_->add(std::move(read_cloud));
  add(std::move(keyframe));
}

void KeyframeGraph::keep_clouds_compact() {
  if (shelf_) shelf_->set_budget(0);
}

void KeyframeGraph::connect(int a, int b, const PoseSpread& spread) {
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
    KeyframeLink& known = link(one, other);
    known.spread = smaller(known.spread, spread);
    known.registered = known.registered ? smaller(*known.registered, spread) : spread;
  }
}

void KeyframeGraph::connect_by_loop(int a, int b, const PoseSpread& spread) {
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
    KeyframeLink& known = link(one, other);
    known.spread = smaller(known.spread, spread);
  }
}

void KeyframeGraph::forget_loops() {
  for (std::vector<KeyframeLink>& links : links_) {
    std::erase_if(links, [](const KeyframeLink& link) { return !link.registered; });
    for (KeyframeLink& link : links) link.spread = *link.registered;
  }
}

/// The connection from a keyframe to another one. If it is new, its spread is without limit.
KeyframeLink& KeyframeGraph::link(int of, int to) {
  std::vector<KeyframeLink>& links = links_[static_cast<std::size_t>(of)];
  const auto known = std::ranges::find(links, to, &KeyframeLink::to);
  if (known != links.end()) return *known;
  constexpr double without_limit = std::numeric_limits<double>::infinity();
  return links.emplace_back(KeyframeLink{to, {without_limit, without_limit}, std::nullopt});
}

void KeyframeGraph::set_links(int id, std::vector<KeyframeLink> links) {
  links_[static_cast<std::size_t>(id)] = std::move(links);
}

void KeyframeGraph::set_pose(int id, const Pose& world_from_camera) {
  keyframes_[static_cast<std::size_t>(id)].world_from_camera = world_from_camera;
}

void KeyframeGraph::set_cloud(int id, const KeyframeCloud& cloud) {
  Keyframe& keyframe = keyframes_[static_cast<std::size_t>(id)];
  keyframe.place = PlaceDescriptor(*cloud.load());
  keyframe.cloud = kept(cloud);
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
    std::erase_if(links_[static_cast<std::size_t>(keyframe.id)],
                  [&](const KeyframeLink& link) { return (*this)[link.to].map != keyframe.map; });
  }
}

void KeyframeGraph::settle_maps() {
  for (Keyframe& keyframe : keyframes_) keyframe.taken_in = keyframe.map;
}

void KeyframeGraph::renumber_recordings(std::span<const int> number_of) {
  for (Keyframe& keyframe : keyframes_) {
    keyframe.recording = number_of[static_cast<std::size_t>(keyframe.recording)];
  }
}

void KeyframeGraph::shrink(int size) {
  keyframes_.resize(static_cast<std::size_t>(size));
  links_.resize(static_cast<std::size_t>(size));
}

std::vector<const Keyframe*> KeyframeGraph::around(int id, const Pose& pose, int count,
                                                   const KeyframeSpacing& steps) const {
  const auto steps_away = [&](int other) {
    return steps.between((*this)[other].world_from_camera, pose);
  };
  std::vector<int> ids;
  for (const auto& [other, spread] : well_connected_to(id)) {
    if (other != id) ids.push_back(other);
  }
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

std::map<int, PoseSpread> KeyframeGraph::well_connected_to(int id) const {
  std::map<int, PoseSpread> reached{{id, {}}};
  std::map<int, PoseSpread> border = reached;
  for (int hops = 0; hops < max_hops; ++hops) {
    std::map<int, PoseSpread> next;
    for (const auto& [from, spread] : border) {
      for (const KeyframeLink& link : links(from)) {
        const PoseSpread sum = spread + link.spread;
        if (sum.translation_m2 > well_connected_sigma_m * well_connected_sigma_m) continue;
        const auto [known, is_new] = reached.try_emplace(link.to, sum);
        if (!is_new && known->second.translation_m2 <= sum.translation_m2) continue;
        known->second = sum;
        next[link.to] = sum;
      }
    }
    border = std::move(next);
  }
  return reached;
}

std::vector<std::optional<PoseSpread>> KeyframeGraph::spreads_from(int id,
                                                                   double most_sigma_m) const {
  using Reached = std::pair<int, PoseSpread>;  // id and spread
  std::vector<std::optional<PoseSpread>> spreads(keyframes_.size());
  const auto is_farther = [](const Reached& one, const Reached& other) {
    return one.second.translation_m2 > other.second.translation_m2;
  };
  std::priority_queue<Reached, std::vector<Reached>, decltype(is_farther)> open(is_farther);
  open.emplace(id, PoseSpread{});
  while (!open.empty()) {
    const auto [nearest, spread] = open.top();
    open.pop();
    if (spread.translation_sigma_m() > most_sigma_m) break;
    std::optional<PoseSpread>& known = spreads[static_cast<std::size_t>(nearest)];
    if (known) continue;
    known = spread;
    for (const KeyframeLink& next : links(nearest)) {
      if (!spreads[static_cast<std::size_t>(next.to)]) {
        open.emplace(next.to, spread + next.spread);
      }
    }
  }
  return spreads;
}

void KeyframeGraph::reconnect() {
  constexpr double well_connected_m2 = well_connected_sigma_m * well_connected_sigma_m;
  const auto is_loose = [](const KeyframeLink& link) {
    return link.spread.translation_m2 > well_connected_m2;
  };
  for (int id = 0; id < size(); ++id) {
    const std::vector<KeyframeLink> before = links_[static_cast<std::size_t>(id)];
    if (std::ranges::none_of(before, is_loose)) continue;
    const auto spreads = spreads_from(id, well_connected_sigma_m);
    for (const KeyframeLink& link : before) {
      const std::optional<PoseSpread>& spread = spreads[static_cast<std::size_t>(link.to)];
      if (spread) connect_by_loop(id, link.to, *spread);
    }
  }
}

}  // namespace tofmap
