// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_pair.hpp"

#include "free_space.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// Largest correspondence distances, in voxels of the level. On the coarsest level, poses from
/// features may be wrong by more than a voxel.
constexpr double coarse_distance_voxels = 2.5;
constexpr double fine_distance_voxels = 2;

/// Number of source points used: enough to compare guesses, and enough to average noise.
constexpr std::size_t coarse_points = 1500;
constexpr std::size_t fine_points = 15000;

/// Poses are the same if points at the RMS radius of the source move by less than this.
constexpr double same_pose_voxels = 4;

/// Largest share of free-space violations. Moving objects and sensor errors cause smaller shares.
constexpr double max_contradiction = 0.023;

/// Small overlaps fit by chance more easily than large ones: the required inlier ratio is increased
/// by up to this as the overlap decreases.
constexpr double more_without_overlap = 0.15;

/// Largest quality of the second best pose relative to the best one. Above it, the pair is
/// ambiguous.
constexpr double max_runner_up = 0.8;

/// Smallest number of matches that do not agree by chance.
constexpr int least_support = 15;

constexpr double contradicted_quality = 0.01;

/// A pose with the measures of its quality.
struct Candidate {
  CloudIcpResult icp;
  int support = 0;
  CloudFit fit;
  double free_space_violation = 0;

  /// Quality for ranking. A pose with too many free-space violations ranks behind all others.
  double quality() const {
    const double share = fit.overlap * fit.inlier_ratio;
    return free_space_violation > max_contradiction ? contradicted_quality * share : share;
  }
};

/// The fit of whichever cloud overlaps the other more, so that a small cloud within a large one
/// counts as a good fit.
CloudFit mutual_fit(const OrientedCloud& source, const OrientedCloud& target, const Pose& pose) {
  const CloudFit there = measure_fit(source, target, pose);
  const CloudFit back = measure_fit(target, source, pose.inverse());
  return there.overlap >= back.overlap ? there : back;
}

double radius_m(const OrientedCloud& cloud) {
  double squared = 0;
  for (const Eigen::Vector3f& point : cloud.points_m) squared += point.squaredNorm();
  return std::sqrt(squared / static_cast<double>(cloud.size()));
}

bool is_same_pose(const Pose& a, const Pose& b, double lever_m, double tolerance_m) {
  return (a.translation() - b.translation()).norm() + lever_m * rotation_angle_rad(a, b) <
         tolerance_m;
}

/// The larger shares of either cloud.
struct Contradiction {
  double free_space_violation = 0;
  double windows = 0;

  void include(const FreeSpaceEvidence& evidence) {
    free_space_violation = std::max(free_space_violation, evidence.violation_share());
    windows = std::max(windows, evidence.window_share());
  }
};

Contradiction contradiction(const LevelledCloud& source, const LevelledCloud& target,
                            const Pose& pose) {
  Contradiction found;
  found.include(least_evidence(target.views, source, pose));
  found.include(least_evidence(source.views, target, pose.inverse()));
  return found;
}

/// Refines the guesses on the coarsest level. Returns distinct poses, best quality first.
std::vector<Candidate> refine_guesses(const LevelledCloud& source_cloud,
                                      const LevelledCloud& target_cloud,
                                      const std::vector<AlignmentGuess>& guesses,
                                      CloudMethod method) {
  const OrientedCloud& source = source_cloud.levels.front();
  const OrientedCloud& target = target_cloud.levels.front();
  const double lever_m = radius_m(source);
  std::vector<Candidate> all;
  for (const AlignmentGuess& guess : guesses) {
    Candidate candidate;
    candidate.icp = align_clouds(source, target, guess.target_from_source,
                                 {method, coarse_distance_voxels * target.voxel_m, coarse_points});
    candidate.support = guess.support;
    candidate.fit = mutual_fit(source, target, candidate.icp.target_from_source);
    candidate.free_space_violation =
        contradiction(source_cloud, target_cloud, candidate.icp.target_from_source)
            .free_space_violation;
    all.push_back(candidate);
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Candidate::quality);
  std::vector<Candidate> distinct;
  for (const Candidate& candidate : all) {
    const bool is_known = std::ranges::any_of(distinct, [&](const Candidate& other) {
      return is_same_pose(candidate.icp.target_from_source, other.icp.target_from_source, lever_m,
                          same_pose_voxels * target.voxel_m);
    });
    if (!is_known) distinct.push_back(candidate);
  }
  return distinct;
}

PairVerdict verdict_of(const CloudPair& pair, const CloudRegistrationOptions& options) {
  if (pair.support < least_support) return PairVerdict::few_matches;
  if (pair.fit.overlap < options.min_overlap) return PairVerdict::low_overlap;
  const double least = options.min_inlier_ratio + more_without_overlap * (1 - pair.fit.overlap);
  if (pair.fit.inlier_ratio < least) return PairVerdict::low_inliers;
  if (pair.free_space_violation > max_contradiction) return PairVerdict::contradicted;
  if (pair.direction_share < options.min_direction_share) return PairVerdict::degenerate;
  if (pair.runner_up > max_runner_up) return PairVerdict::ambiguous;
  return PairVerdict::registered;
}

}  // namespace

CloudPair align_pair(const LevelledCloud& source, const LevelledCloud& target,
                     const CloudRegistrationOptions& options) {
  const CloudMethod method = options.method;
  CloudPair pair;
  pair.tested_views = static_cast<int>(source.views.size() + target.views.size());
  const auto matches = match_features(source.features, target.features);
  pair.matches = static_cast<int>(matches.size());
  const auto guesses = guess_alignments(source.levels.front(), target.levels.front(), matches);
  if (guesses.empty()) return pair;
  const std::vector<Candidate> candidates = refine_guesses(source, target, guesses, method);
  Candidate best = candidates.front();
  if (candidates.size() > 1) pair.runner_up = candidates[1].quality() / best.quality();
  const std::size_t levels = std::min(source.levels.size(), target.levels.size());
  for (std::size_t level = 1; level < levels; ++level) {
    best.icp =
        align_clouds(source.levels[level], target.levels[level], best.icp.target_from_source,
                     {method, fine_distance_voxels * target.levels[level].voxel_m, fine_points});
  }
  pair.support = best.support;
  // The fit is judged on the coarsest level, since means over large voxels have little noise.
  pair.fit = mutual_fit(source.levels.front(), target.levels.front(), best.icp.target_from_source);
  const Contradiction contradicting = contradiction(source, target, best.icp.target_from_source);
  pair.free_space_violation = contradicting.free_space_violation;
  pair.window_share = contradicting.windows;
  pair.direction_share = best.icp.direction_shares.minCoeff();
  pair.covariance = best.icp.covariance;
  pair.target_from_source = best.icp.target_from_source;
  pair.verdict = verdict_of(pair, options);
  return pair;
}

}  // namespace tofmap
