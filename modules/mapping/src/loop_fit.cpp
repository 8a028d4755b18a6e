// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace tofmap {
namespace {

/// So many loops that agree with each other tell of an error of the path.
constexpr std::size_t least_agreeing = 2;

/// Standard deviations within which loops agree.
constexpr double most_deviations = 2;

using Loops = std::vector<const PoseEdge*>;

const Keyframe& at(std::span<const Keyframe> keyframes, int id) {
  return keyframes[static_cast<std::size_t>(id)];
}

/// Whether one loop puts the keyframe of the other, up to the drift between, where that puts it.
bool agree(const PoseEdge& one, const PoseEdge& other, std::span<const Keyframe> keyframes,
           const LoopOptions& options) {
  const auto found = [&](const PoseEdge& loop) {
    return at(keyframes, loop.from).world_from_camera * loop.from_from_to;
  };
  const auto path_between_m = [&](int a, int b) {
    return std::abs(at(keyframes, a).path_m - at(keyframes, b).path_m);
  };
  const Pose correction = found(one) * at(keyframes, one.to).world_from_camera.inverse();
  const MotionPrior prior =
      drift_prior(correction * at(keyframes, other.to).world_from_camera,
                  path_between_m(one.from, other.from) + path_between_m(one.to, other.to), options);
  return deviation(prior, found(other)) < most_deviations;
}

/// The loop with which most agree, and those.
Loops most_that_agree(const Loops& loops, std::span<const Keyframe> keyframes,
                      const LoopOptions& options) {
  Loops most;
  for (const PoseEdge* one : loops) {
    Loops agreeing;
    std::ranges::copy_if(loops, std::back_inserter(agreeing), [&](const PoseEdge* other) {
      return other == one || agree(*one, *other, keyframes, options);
    });
    if (agreeing.size() > most.size()) most = std::move(agreeing);
  }
  return most;
}

/// These loops, and the other edges with errors that come to those of drift in the end.
std::vector<PoseEdge> with_drift(std::span<const PoseEdge> edges, const Loops& loops,
                                 std::span<const Keyframe> keyframes, const LoopOptions& options) {
  const double drift_m = options.drift_share * keyframes.back().path_m;
  const double share_m = drift_m / std::sqrt(static_cast<double>(keyframes.size()));
  std::vector<PoseEdge> loosened;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) continue;
    loosened.push_back(edge);
    widen(loosened.back(), drift_rad_per_drift_m * share_m, share_m);
  }
  for (const PoseEdge* loop : loops) loosened.push_back(*loop);
  return loosened;
}

}  // namespace

PoseGraphResult fit_loops(std::span<const Keyframe> keyframes, std::span<const PoseEdge> edges,
                          const LoopOptions& options) {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.world_from_camera);
  PoseGraphResult fitted = optimise_pose_graph(poses, edges, options.kernel_width);
  Loops loops;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) loops.push_back(&edge);
  }
  const Loops agreeing = most_that_agree(loops, keyframes, options);
  const auto outvoted = std::ranges::count_if(agreeing, [&](const PoseEdge* loop) {
    return is_outvoted(mahalanobis_distance(*loop, fitted.poses), options.kernel_width);
  });
  const bool tell_of_drift = agreeing.size() >= least_agreeing &&
                             2 * agreeing.size() > loops.size() &&
                             2 * static_cast<std::size_t>(outvoted) > agreeing.size();
  if (!tell_of_drift) return fitted;
  fitted = optimise_pose_graph(std::move(poses), with_drift(edges, agreeing, keyframes, options),
                               options.kernel_width);
  fitted.edge_mahalanobis.clear();
  for (const PoseEdge& edge : edges) {
    fitted.edge_mahalanobis.push_back(mahalanobis_distance(edge, fitted.poses));
  }
  return fitted;
}

}  // namespace tofmap
