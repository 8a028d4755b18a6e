// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <tofmap/registration/pose_graph.hpp>

namespace tofmap::test {

inline PoseEdge edge(int from, int to, const Pose& motion, double sigma = 0.01) {
  PoseEdge out;
  out.from = from;
  out.to = to;
  out.from_from_to = motion;
  out.covariance *= sigma * sigma;
  return out;
}

inline PoseEdge loop(int from, int to, const Pose& motion, double sigma = 0.01) {
  PoseEdge out = edge(from, to, motion, sigma);
  out.may_be_wrong = true;
  return out;
}

inline Pose along_x(double metres) { return moved_by({0, 0, 0}, {metres, 0, 0}); }

/// A camera that goes round in a circle, always looking ahead; the last pose is the first again.
inline std::vector<Pose> circle(int steps) {
  std::vector<Pose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / steps;
    poses.push_back(moved_by({0, 0, angle}, {3 * std::sin(angle), 3 - 3 * std::cos(angle), 0.1}));
  }
  return poses;
}

/// The edges from each pose to the next, as they truly are.
inline std::vector<PoseEdge> chain(const std::vector<Pose>& poses) {
  std::vector<PoseEdge> edges;
  for (int i = 0; i + 1 < static_cast<int>(poses.size()); ++i) {
    edges.push_back(edge(i, i + 1, poses[i].inverse() * poses[i + 1]));
  }
  return edges;
}

/// The chain of motions, each with the same error.
inline std::vector<Pose> drifted(const std::vector<PoseEdge>& edges, const Pose& error) {
  std::vector<Pose> poses{Pose::Identity()};
  for (const PoseEdge& step : edges) poses.push_back(poses.back() * step.from_from_to * error);
  return poses;
}

inline double largest_error_m(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose error = (truth[0].inverse() * truth[i]).inverse() * (poses[0].inverse() * poses[i]);
    largest = std::max(largest, error.translation().norm());
  }
  return largest;
}

}  // namespace tofmap::test
