// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap {

/// What the surroundings of a point look like: fast point feature histograms (Rusu, Blodow, Beetz,
/// ICRA 2009), which do not depend on the frame.
using PointFeature = std::array<float, 33>;

/// One feature a point, from neighbours within five voxels (PCL).
std::vector<PointFeature> point_features(const OrientedCloud& cloud);

/// Points of two clouds that look alike.
struct FeatureMatch {
  int source = 0;
  int target = 0;
};

/// Pairs of points each of which looks most like the other; at most 3000, evenly drawn.
std::vector<FeatureMatch> match_features(const std::vector<PointFeature>& source,
                                         const std::vector<PointFeature>& target);

/// A way to lay the source onto the target.
struct AlignmentGuess {
  Pose target_from_source = Pose::Identity();
  int support = 0;  ///< matches that agree
};

/// Poses that many matches agree on, the best supported first, ten at most; none if there is none.
///
/// Two matches can both be right only if their points are as far apart, and their normals at the
/// same angles, in both clouds. Right ones, unlike chance, also share many others that each of them
/// goes with: from those that do, poses are estimated (Chen, Sun, Yang, Tao, "SC²-PCR", CVPR 2022).
/// Nothing is drawn at random. Lengths agree within one and a half voxels.
std::vector<AlignmentGuess> guess_alignments(const OrientedCloud& source,
                                             const OrientedCloud& target,
                                             const std::vector<FeatureMatch>& matches);

}  // namespace tofmap
