// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_graph.hpp"

#include <algorithm>
#include <numeric>

#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {
namespace {

/// Indices of the registered pairs, best quality first.
std::vector<std::size_t> by_quality(const std::vector<CloudPair>& pairs) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].verdict == PairVerdict::registered) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) {
    return pairs[i].fit.overlap * pairs[i].fit.inlier_ratio;
  });
  return order;
}

/// The connected component that each cloud belongs to, named by the lowest index of its clouds.
std::vector<int> components_of(std::size_t clouds, const std::vector<CloudPair>& pairs) {
  std::vector<int> component(clouds);
  std::iota(component.begin(), component.end(), 0);
  for (const CloudPair& pair : pairs) {
    if (pair.verdict != PairVerdict::registered) continue;
    const int one = component[static_cast<std::size_t>(pair.source)];
    const int other = component[static_cast<std::size_t>(pair.target)];
    std::ranges::replace(component, std::max(one, other), std::min(one, other));
  }
  return component;
}

/// The connected component with most clouds. Of equally large components, the one with the lowest
/// index.
int largest_component(const std::vector<int>& component) {
  int best = 0;
  for (int i = 0; i < static_cast<int>(component.size()); ++i) {
    if (std::ranges::count(component, i) > std::ranges::count(component, best)) best = i;
  }
  return best;
}

/// Initial poses: relative poses chained along the pairs of best quality, starting at cloud
/// `first`. Clouds that are not connected with it keep the identity.
std::vector<Pose> chained_poses(std::size_t clouds, const std::vector<CloudPair>& pairs,
                                int first) {
  std::vector<Pose> poses(clouds, Pose::Identity());
  std::vector<bool> is_reached(clouds, false);
  is_reached[static_cast<std::size_t>(first)] = true;
  const std::vector<std::size_t> order = by_quality(pairs);
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (const std::size_t i : order) {
      const auto s = static_cast<std::size_t>(pairs[i].source);
      const auto t = static_cast<std::size_t>(pairs[i].target);
      if (is_reached[s] == is_reached[t]) continue;
      if (is_reached[t]) poses[s] = poses[t] * pairs[i].target_from_source;
      if (is_reached[s]) poses[t] = poses[s] * pairs[i].target_from_source.inverse();
      is_reached[s] = is_reached[t] = has_grown = true;
      break;  // the next pair is again the best one between reached and unreached clouds
    }
  }
  return poses;
}

/// Fits the poses to all registered pairs, and gives the rejected pairs the verdict `disagrees`.
std::vector<Pose> fitted_poses(std::vector<Pose> poses, std::vector<CloudPair>& pairs,
                               double slack_m, double kernel_width) {
  constexpr double slack_rad = 0.002;
  Eigen::Matrix<double, 6, 1> slack;
  slack << Eigen::Vector3d::Constant(slack_rad), Eigen::Vector3d::Constant(slack_m);
  std::vector<PoseEdge> edges;
  std::vector<CloudPair*> used;
  for (CloudPair& pair : pairs) {
    if (pair.verdict != PairVerdict::registered) continue;
    PoseEdge edge;
    edge.from = pair.target;
    edge.to = pair.source;
    edge.from_from_to = pair.target_from_source;
    edge.covariance = pair.covariance;
    edge.covariance.diagonal() += slack.cwiseAbs2();
    edge.may_be_wrong = true;
    edges.push_back(edge);
    used.push_back(&pair);
  }
  PoseGraphResult fitted = optimise_pose_graph(std::move(poses), edges, kernel_width);
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i]->mahalanobis_distance = fitted.edge_mahalanobis[i];
    if (is_rejected(used[i]->mahalanobis_distance, kernel_width)) {
      used[i]->verdict = PairVerdict::disagrees;
    }
  }
  return std::move(fitted.poses);
}

}  // namespace

std::vector<std::optional<Pose>> fit_graph(std::size_t clouds, std::vector<CloudPair>& pairs,
                                           double slack_m, double kernel_width) {
  std::vector<std::optional<Pose>> registered(clouds);
  int first = largest_component(components_of(clouds, pairs));
  const std::vector<Pose> poses =
      fitted_poses(chained_poses(clouds, pairs, first), pairs, slack_m, kernel_width);
  // Without the rejected pairs, fewer clouds may be connected.
  const std::vector<int> component = components_of(clouds, pairs);
  first = largest_component(component);
  if (std::ranges::count(component, first) < 2) return registered;
  const Pose first_from_world = poses[static_cast<std::size_t>(first)].inverse();
  for (std::size_t i = 0; i < clouds; ++i) {
    if (component[i] == first) registered[i] = first_from_world * poses[i];
  }
  return registered;
}

}  // namespace tofmap
