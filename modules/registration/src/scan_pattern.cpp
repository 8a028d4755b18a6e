// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/scan_pattern.hpp"

#include "pattern_at.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

constexpr double most_hidden = 0.02;

/// That of a camera of 57 by 43 degrees is 0.935, that of a room seen from its own size away 0.96.
constexpr double most_concentrated = 0.95;

double concentration_of(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& place) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += (point - place).stableNormalized();
  return sum.norm() / static_cast<double>(points.size());
}

double median_range(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& place) {
  std::vector<double> ranges;
  for (const Eigen::Vector3d& point : points) ranges.push_back((point - place).norm());
  return median(ranges);
}

}  // namespace

bool ScanPattern::is_evidence_for() const {
  return (hides_less_than_around() && concentration < most_concentrated) ||
         is_more_regular_than_around(0.6);
}

bool ScanPattern::hides_less_than_around() const {
  constexpr double times_nearby = 3;
  constexpr double least_nearby = 0.003;  // six of 2000 points
  return hidden_share <= most_hidden && hidden_nearby > times_nearby * hidden_share + least_nearby;
}

bool ScanPattern::is_more_regular_than_around(double share) const {
  return hidden_share <= most_hidden && roughness < share * roughness_nearby;
}

bool ScanPattern::is_evidence_against() const {
  constexpr double least_hidden = 0.01;
  constexpr double least_of_nearby = 0.7;
  return hidden_share > least_hidden && hidden_share > least_of_nearby * hidden_nearby;
}

ScanPattern scan_pattern(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& place) {
  constexpr double away = 0.1;
  if (points.empty()) return {};
  const std::optional<Pattern> here = pattern_at(points, place);
  if (!here) return {};
  ScanPattern out{here->hidden_share, 0, here->roughness, here->roughness,
                  concentration_of(points, place)};
  std::vector<double> roughness_nearby;
  const double step = away * median_range(points, place);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d moved = place + sign * step * Eigen::Vector3d::Unit(axis);
      const std::optional<Pattern> nearby = pattern_at(points, moved);
      if (!nearby) return {};
      out.hidden_nearby += nearby->hidden_share / 6;
      roughness_nearby.push_back(nearby->roughness);
    }
  }
  out.roughness_nearby = std::ranges::min(roughness_nearby);
  return out;
}

}  // namespace tofmap
