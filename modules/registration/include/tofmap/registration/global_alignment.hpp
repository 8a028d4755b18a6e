// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap {

/// Fast point feature histogram: describes the surface around a point, independently of the frame
/// of the cloud (Rusu, Blodow, Beetz, ICRA 2009).
using PointFeature = std::array<float, 33>;

/// One feature per point, computed by PCL from the neighbours within five voxels. All zeros for a
/// point without neighbours.
std::vector<PointFeature> point_features(const OrientedCloud& cloud);

/// A point of the source and a point of the target with similar features.
struct FeatureMatch {
  int source = 0;  ///< index in the source cloud
  int target = 0;  ///< index in the target cloud
};

/// Mutual nearest neighbours in feature space: pairs in which each feature is the most similar one
/// to the other. If there are more than 3000, 3000 of them at even intervals. Empty if either cloud
/// is empty.
std::vector<FeatureMatch> match_features(const std::vector<PointFeature>& source,
                                         const std::vector<PointFeature>& target);

/// A hypothesis about the pose of the source relative to the target.
struct AlignmentGuess {
  Pose target_from_source = Pose::Identity();
  int support = 0;  ///< number of matches that agree with the pose within 1.5 voxels
};

/// Finds up to ten poses that many matches agree on, in descending order of support, without an
/// initial pose. Empty if no pose is supported by at least five matches.
///
/// Two matches are compatible if the distance between their points is the same in both clouds
/// within 1.5 voxels, and so are the angles of their normals. Correct matches are compatible with
/// many of the same other matches, wrong ones are not: each pose is estimated from a match and the
/// matches that have most such matches in common with it (Chen, Sun, Yang, Tao, "SC²-PCR", CVPR
/// 2022). The search is deterministic; nothing is sampled at random.
std::vector<AlignmentGuess> guess_alignments(const OrientedCloud& source,
                                             const OrientedCloud& target,
                                             const std::vector<FeatureMatch>& matches);

}  // namespace tofmap
