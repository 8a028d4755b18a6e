// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_fit.hpp"

namespace tofmap {

void add_loop(MapContent& content, const PoseEdge& edge) {
  const Pose found = content.keyframes[edge.from].world_from_camera * edge.from_from_to;
  const Pose& believed = content.keyframes[edge.to].world_from_camera;
  content.edges.push_back(edge);
  content.loops.push_back({.from_frame = content.keyframes[edge.from].frame_index,
                           .to_frame = content.keyframes[edge.to].frame_index,
                           .error_m = (found.translation() - believed.translation()).norm()});
}

LoopFit fit_poses(MapContent& content, const LoopOptions& options, std::size_t held) {
  LoopFit fitted = fit_loops(content.keyframes.all(), content.edges, options, held);
  for (int id = 0; id < content.keyframes.size(); ++id) {
    content.keyframes.set_pose(id, fitted.poses[static_cast<std::size_t>(id)]);
  }
  return fitted;
}

void fit_map(MapContent& content, const LoopOptions& options, std::size_t held) {
  const LoopFit fitted = fit_poses(content, options, held);
  content.keyframes.forget_loops();
  auto loop = content.loops.begin();
  for (std::size_t i = 0; i < content.edges.size(); ++i) {
    const PoseEdge& edge = content.edges[i];
    if (!edge.may_be_wrong) continue;
    loop->mahalanobis_distance = fitted.edge_mahalanobis[i];
    loop->is_used = fitted.is_used[i];
    // The relative pose of both ends is now correct, so frames may be registered with either.
    if (loop->is_used) {
      content.keyframes.connect_by_loop(edge.from, edge.to, spread_of(edge.covariance));
    }
    ++loop;
  }
  content.keyframes.reconnect();
}

}  // namespace tofmap
