// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_fit.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/keyframe_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace tofmap {
namespace {

/// Smallest number of loops that must agree to move the path.
constexpr std::ptrdiff_t least_agreeing_loops = 3;

/// Two loops agree within this many standard deviations.
constexpr double most_sigmas = 2;

using Loops = std::vector<const PoseEdge*>;

const Keyframe& at(std::span<const Keyframe> keyframes, int id) {
  return keyframes[static_cast<std::size_t>(id)];
}

/// Where a loop puts its later keyframe.
Pose found_by(const PoseEdge& loop, std::span<const Keyframe> keyframes) {
  return at(keyframes, loop.from).world_from_camera * loop.from_from_to;
}

/// Whether both loops correct the path of the same map in the same way: the correction by one loop
/// moves the later keyframe of the other loop to where that loop puts it, up to the drift between
/// both.
bool agree(const PoseEdge& one, const PoseEdge& other, std::span<const Keyframe> keyframes,
           const LoopOptions& options) {
  if (at(keyframes, one.from).map != at(keyframes, other.from).map ||
      at(keyframes, one.to).map != at(keyframes, other.to).map) {
    return false;
  }
  const auto path_between_m = [&](int a, int b) {
    return std::abs(at(keyframes, a).path_m - at(keyframes, b).path_m);
  };
  const Pose correction =
      found_by(one, keyframes) * at(keyframes, one.to).world_from_camera.inverse();
  const MotionPrior prior =
      drift_prior(correction * at(keyframes, other.to).world_from_camera,
                  path_between_m(one.from, other.from) + path_between_m(one.to, other.to), options);
  return prior_deviation_sigmas(prior, found_by(other, keyframes)) < most_sigmas;
}

/// Whether a loop may move the path, since others agree with it, or does not move it.
bool is_supported(const PoseEdge& loop, const Loops& loops, std::span<const Keyframe> keyframes,
                  const LoopOptions& options) {
  if (!would_move(loop, keyframes)) return true;
  return std::ranges::count_if(loops, [&](const PoseEdge* other) {
           return agree(loop, *other, keyframes, options);
         }) >= least_agreeing_loops;
}

/// Sum of the rotations from each keyframe to the next.
double turned_rad(std::span<const Keyframe> keyframes) {
  double sum = 0;
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    if (keyframes[i].map != keyframes[i - 1].map) continue;
    sum += rotation_angle_rad(keyframes[i - 1].world_from_camera, keyframes[i].world_from_camera);
  }
  return sum;
}

/// Edges for the second fit: `loops`, and the edges of odometry with covariances increased so that
/// they add up to the drift of the whole path.
std::vector<PoseEdge> with_drift(std::span<const PoseEdge> edges, const Loops& loops,
                                 std::span<const Keyframe> keyframes, const LoopOptions& options) {
  const double drift_m = options.drift_share * keyframes.back().path_m;
  const double drift_rad =
      std::hypot(drift_rad_per_drift_m * drift_m, options.drift_share * turned_rad(keyframes));
  const double per_edge = 1 / std::sqrt(static_cast<double>(keyframes.size()));
  std::vector<PoseEdge> loosened;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) continue;
    loosened.push_back(edge);
    widen(loosened.back(), per_edge * drift_rad, per_edge * drift_m);
  }
  for (const PoseEdge* loop : loops) loosened.push_back(*loop);
  return loosened;
}

/// Whether most of the loops agree with each other, but not with the poses that the path allows.
bool tell_of_drift(const Loops& agreeing, const Loops& supported, const std::vector<Pose>& poses,
                   const LoopOptions& options) {
  const auto rejected = std::ranges::count_if(agreeing, [&](const PoseEdge* loop) {
    return is_rejected(mahalanobis_distance(*loop, poses), options.kernel_width);
  });
  return agreeing.size() > 1 && 2 * agreeing.size() > supported.size() &&
         2 * static_cast<std::size_t>(rejected) > agreeing.size();
}

}  // namespace

bool would_move(const PoseEdge& loop, std::span<const Keyframe> keyframes) {
  constexpr double most_m = KeyframeGraph::well_connected_sigma_m;
  constexpr double distance_m = 1;
  return !are_near(found_by(loop, keyframes), at(keyframes, loop.to).world_from_camera, most_m,
                   most_m / distance_m);
}

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

LoopFit fit_loops(std::span<const Keyframe> keyframes, std::span<const PoseEdge> edges,
                  const LoopOptions& options, std::size_t held) {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.world_from_camera);
  Loops loops;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) loops.push_back(&edge);
  }
  std::vector<PoseEdge> trusted;
  Loops supported;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong && !is_supported(edge, loops, keyframes, options)) continue;
    trusted.push_back(edge);
    if (edge.may_be_wrong) supported.push_back(&edge);
  }
  PoseGraphResult fitted = optimise_pose_graph(poses, trusted, options.kernel_width, held);
  const Loops agreeing = most_that_agree(supported, keyframes, options);
  if (tell_of_drift(agreeing, supported, fitted.poses, options)) {
    fitted = optimise_pose_graph(std::move(poses), with_drift(edges, agreeing, keyframes, options),
                                 options.kernel_width, held);
    supported = agreeing;
  }
  LoopFit fit{.poses = std::move(fitted.poses), .edge_mahalanobis = {}, .is_used = {}};
  for (const PoseEdge& edge : edges) {
    const double distance = mahalanobis_distance(edge, fit.poses);
    fit.edge_mahalanobis.push_back(distance);
    fit.is_used.push_back(!edge.may_be_wrong ||
                          (std::ranges::find(supported, &edge) != supported.end() &&
                           !is_rejected(distance, options.kernel_width)));
  }
  return fit;
}

}  // namespace tofmap
