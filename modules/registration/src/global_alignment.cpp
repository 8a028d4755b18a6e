// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/global_alignment.hpp"

#include "bit_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

constexpr double length_tolerance_voxels = 1.5;
constexpr double least_length_voxels = 5;  // points closer together share their neighbours
constexpr float normal_cos_tolerance = 0.35F;
constexpr std::size_t most_seeds = 200;
constexpr std::size_t most_guesses = 10;
constexpr std::size_t seed_companions = 20;
constexpr int least_support = 5;

/// A match with the points and normals of both clouds.
struct PlacedMatch {
  Eigen::Vector3f source_m, target_m;
  Eigen::Vector3f source_normal, target_normal;
};

std::vector<PlacedMatch> registered(const OrientedCloud& source, const OrientedCloud& target,
                                    const std::vector<FeatureMatch>& matches) {
  std::vector<PlacedMatch> out;
  for (const FeatureMatch& match : matches) {
    const auto s = static_cast<std::size_t>(match.source);
    const auto t = static_cast<std::size_t>(match.target);
    out.push_back({source.points_m[s], target.points_m[t], source.normals[s], target.normals[t]});
  }
  return out;
}

/// Whether two matches are compatible: the distance between their points and the angles of their
/// normals are the same in both clouds, within tolerances.
bool go_together(const PlacedMatch& a, const PlacedMatch& b, float voxel_m) {
  const Eigen::Vector3f in_source = b.source_m - a.source_m;
  const Eigen::Vector3f in_target = b.target_m - a.target_m;
  const float length = in_source.norm();
  if (length < static_cast<float>(least_length_voxels) * voxel_m) return false;
  if (std::abs(length - in_target.norm()) > static_cast<float>(length_tolerance_voxels) * voxel_m) {
    return false;
  }
  const float angles =
      std::abs(a.source_normal.dot(b.source_normal) - a.target_normal.dot(b.target_normal));
  const float from_a =
      std::abs(a.source_normal.dot(in_source) - a.target_normal.dot(in_target)) / length;
  const float from_b =
      std::abs(b.source_normal.dot(in_source) - b.target_normal.dot(in_target)) / length;
  return std::max({angles, from_a, from_b}) < normal_cos_tolerance;
}

BitMatrix compatibility(const std::vector<PlacedMatch>& matches, double voxel_m) {
  const auto voxel = static_cast<float>(voxel_m);
  const int count = static_cast<int>(matches.size());
  BitMatrix together(matches.size());
  // Rows share no words, so threads can fill them in parallel.
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (i != j && go_together(matches[i], matches[j], voxel)) together.set(i, j);
    }
  }
  return together;
}

/// Score of each match: the number of matches compatible with both it and another match, summed
/// over all matches that are compatible with it.
std::vector<double> seed_scores(const BitMatrix& together, std::size_t size) {
  std::vector<double> scores(size);
  const int count = static_cast<int>(size);
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (together(i, j)) scores[i] += together.common(i, j);
    }
  }
  return scores;
}

/// A match and the matches that have most compatible matches in common with it.
std::vector<std::size_t> companions(const BitMatrix& together, std::size_t seed, std::size_t size) {
  struct Companion {
    int common;
    std::size_t index;
  };
  std::vector<Companion> all;
  for (std::size_t j = 0; j < size; ++j) {
    if (together(seed, j)) all.push_back({together.common(seed, j), j});
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Companion::common);
  std::vector<std::size_t> out{seed};
  for (std::size_t i = 0; i < std::min(all.size(), seed_companions); ++i) {
    out.push_back(all[i].index);
  }
  return out;
}

Pose fitted_pose(const std::vector<PlacedMatch>& matches, const std::vector<std::size_t>& chosen) {
  const auto count = static_cast<Eigen::Index>(chosen.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PlacedMatch& match = matches[chosen[static_cast<std::size_t>(i)]];
    from.col(i) = match.source_m.cast<double>();
    to.col(i) = match.target_m.cast<double>();
  }
  constexpr bool with_scaling = false;
  return Pose(Eigen::umeyama(from, to, with_scaling));
}

std::vector<std::size_t> supporters(const std::vector<PlacedMatch>& matches, const Pose& pose,
                                    double tolerance_m) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d moved = pose * matches[i].source_m.cast<double>();
    if ((moved - matches[i].target_m.cast<double>()).norm() < tolerance_m) out.push_back(i);
  }
  return out;
}

}  // namespace

std::vector<AlignmentGuess> guess_alignments(const OrientedCloud& source,
                                             const OrientedCloud& target,
                                             const std::vector<FeatureMatch>& feature_matches) {
  const std::vector<PlacedMatch> matches = registered(source, target, feature_matches);
  const double voxel_m = std::max(source.voxel_m, target.voxel_m);
  const BitMatrix together = compatibility(matches, voxel_m);
  const std::vector<double> scores = seed_scores(together, matches.size());
  std::vector<std::size_t> seeds(matches.size());
  std::iota(seeds.begin(), seeds.end(), std::size_t{0});
  std::ranges::stable_sort(seeds, std::ranges::greater(),
                           [&](std::size_t seed) { return scores[seed]; });

  std::vector<AlignmentGuess> guesses;
  std::vector<bool> is_explained(matches.size(), false);
  std::size_t tried = 0;
  for (const std::size_t seed : seeds) {
    if (tried == most_seeds || scores[seed] <= 0) break;
    if (is_explained[seed]) continue;
    ++tried;
    std::vector<std::size_t> chosen = companions(together, seed, matches.size());
    AlignmentGuess guess;
    constexpr int refits = 4;
    for (int i = 0; i < refits && chosen.size() >= 3; ++i) {
      guess.target_from_source = fitted_pose(matches, chosen);
      chosen = supporters(matches, guess.target_from_source, length_tolerance_voxels * voxel_m);
    }
    guess.support = static_cast<int>(chosen.size());
    if (guess.support < least_support) continue;
    for (const std::size_t match : chosen) is_explained[match] = true;
    guesses.push_back(guess);
  }
  std::ranges::stable_sort(guesses, std::ranges::greater(), &AlignmentGuess::support);
  if (guesses.size() > most_guesses) guesses.resize(most_guesses);
  return guesses;
}

}  // namespace tofmap
