// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

namespace tofmap {

/// What the pattern of a cloud's points says about a place as the position of its sensor, compared
/// with six places around it, a tenth of the median range away.
///
/// A sensor takes one range in each direction, and its directions follow a regular pattern whatever
/// the ranges are. Seen from another place, surfaces overlap at their edges, and noise of the
/// ranges and bends of surfaces disturb the pattern.
struct ScanPattern {
  double hidden_share = 0;      ///< share of points that a nearer surface hides from the place
  double hidden_nearby = 0;     ///< the same from the six places around it, on average
  double roughness = 0;         ///< how much the spacing of directions differs between neighbours
  double roughness_nearby = 0;  ///< the same from the six places around it, the smallest
  double concentration = 0;     ///< length of the mean direction: 1 if all directions are the same

  /// Whether the sensor was at the place: hardly any point is hidden, and either three times as
  /// many are hidden around, or the pattern is clearly more regular than around. What is hidden is
  /// no evidence if the directions are concentrated within about 25 degrees of their mean: from far
  /// away, everything is hidden or seen by chance. A cloud of a few plain walls that was
  /// downsampled has no such evidence for any place.
  bool is_evidence_for() const;

  /// Whether the sensor was elsewhere: nearly as many points are hidden as from places around.
  bool is_evidence_against() const;

 private:
  bool hides_less_than_around() const;
  bool is_more_regular_than_around(double share) const;
};

/// Measures the pattern of the directions of a cloud's points as seen from a place, both in the
/// frame and the unit of the cloud.
///
/// A point is hidden if another one is at most 1/1.2 as far away, and their directions differ by
/// less than half of the spacing of directions on the surface of the point. The spacing is that of
/// the second nearest direction of similar range (10 %). Roughness is the median of |log(m / n)|
/// over neighbouring directions with the mean distances m and n to their own four neighbours. 2000
/// points are examined, among 40 000 in directions that are spread over the cloud. All values are
/// 0, which is evidence for nothing, if fewer than 200 points have distinct directions.
ScanPattern scan_pattern(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& place);

}  // namespace tofmap
