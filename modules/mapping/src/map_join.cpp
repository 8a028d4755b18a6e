// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_join.hpp"

#include "tofmap/mapping/loop_fit.hpp"

#include <limits>
#include <map>
#include <set>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {
namespace {

/// A rotation by one radian changes what a camera sees as much as a metre does.
constexpr double metres_per_radian = 1;

}  // namespace

std::size_t recognising_keyframes(const std::vector<const PoseEdge*>& recognitions) {
  std::set<int> keyframes;
  for (const PoseEdge* edge : recognitions) keyframes.insert(edge->to);
  return keyframes.size();
}

std::vector<const PoseEdge*> pointers_to(std::span<const PoseEdge> edges) {
  std::vector<const PoseEdge*> pointers;
  for (const PoseEdge& edge : edges) pointers.push_back(&edge);
  return pointers;
}

MapJoin join_by(const std::vector<const PoseEdge*>& recognitions, int map,
                std::span<const Keyframe> keyframes) {
  const auto at = [&](int id) -> const Keyframe& {
    return keyframes[static_cast<std::size_t>(id)];
  };
  MapJoin join{.into = at(recognitions.front()->from).map,
               .map = map,
               .into_from_map = Pose::Identity(),
               .edges = {}};
  double least_m = std::numeric_limits<double>::infinity();
  for (const PoseEdge* edge : recognitions) {
    join.edges.push_back(*edge);
    const Pose into_from_map = at(edge->from).world_from_camera * edge->from_from_to *
                               at(edge->to).world_from_camera.inverse();
    double deviations_m = 0;
    for (const PoseEdge* other : recognitions) {
      const Pose found = at(other->from).world_from_camera * other->from_from_to;
      const Pose moved = into_from_map * at(other->to).world_from_camera;
      deviations_m += (found.translation() - moved.translation()).norm() +
                      metres_per_radian * rotation_angle_rad(found, moved);
    }
    if (deviations_m >= least_m) continue;
    least_m = deviations_m;
    join.into_from_map = into_from_map;
  }
  return join;
}

std::optional<MapJoin> find_join(std::span<const PoseEdge> recognitions, int map,
                                 std::span<const Keyframe> keyframes, const LoopOptions& options) {
  const auto at = [&](int id) -> const Keyframe& {
    return keyframes[static_cast<std::size_t>(id)];
  };
  std::map<int, std::vector<const PoseEdge*>> by_map;
  for (const PoseEdge& edge : recognitions) {
    if (at(edge.to).map == map) by_map[at(edge.from).map].push_back(&edge);
  }
  std::optional<MapJoin> best;
  for (const auto& [into, edges] : by_map) {
    const auto agreeing = most_that_agree(edges, keyframes, options);
    const bool is_sure = recognising_keyframes(agreeing) >= least_agreeing_keyframes &&
                         2 * agreeing.size() > edges.size();
    if (!is_sure || (best && agreeing.size() <= best->edges.size())) continue;
    best = join_by(agreeing, map, keyframes);
  }
  return best;
}

}  // namespace tofmap
