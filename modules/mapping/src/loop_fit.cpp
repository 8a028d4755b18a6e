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

/// Smallest number of agreeing loops that can prove the path wrong.
constexpr std::size_t least_agreeing = 2;

/// Two loops agree within this many standard deviations.
constexpr double most_sigmas = 2;

using Loops = std::vector<const PoseEdge*>;

const Keyframe& at(std::span<const Keyframe> keyframes, int id) {
  return keyframes[static_cast<std::size_t>(id)];
}

/// Whether both loops correct the path in the same way: the correction by one loop moves the later
/// keyframe of the other loop to where that loop puts it, up to the drift between both.
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
  return prior_deviation_sigmas(prior, found(other)) < most_sigmas;
}

/// Edges for the second fit: `loops`, and the edges of odometry with covariances increased so that
/// they add up to the drift of the whole path.
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

std::vector<const PoseEdge*> most_that_agree(const std::vector<const PoseEdge*>& loops,
                                             std::span<const Keyframe> keyframes,
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
  const auto rejected = std::ranges::count_if(agreeing, [&](const PoseEdge* loop) {
    return is_rejected(mahalanobis_distance(*loop, fitted.poses), options.kernel_width);
  });
  const bool tell_of_drift = agreeing.size() >= least_agreeing &&
                             2 * agreeing.size() > loops.size() &&
                             2 * static_cast<std::size_t>(rejected) > agreeing.size();
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
