// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "target_choice.hpp"

#include "tofmap/mapping/pose_spread.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Candidate {
  const Keyframe* keyframe = nullptr;
  TargetPreview preview;
};

/// A candidate for each keyframe that overlaps the frame enough, by decreasing overlap.
std::vector<Candidate> candidates_of(const SurfaceCloud& cloud, const MotionPrior& prior,
                                     std::span<const Keyframe* const> around,
                                     const CameraModel& camera, double min_overlap,
                                     const RegistrationOptions& registration) {
  std::vector<Candidate> candidates(around.size());
  const int count = static_cast<int>(around.size());
  std::vector<RegistrationTarget> targets;  // before the parallel loop, since loading may throw
  for (const Keyframe* keyframe : around) targets.push_back(target_of(*keyframe));
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) {
    candidates[i] = {around[i], preview_target(cloud, prior.world_from_camera, targets[i], camera,
                                               registration)};
  }
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return candidate.preview.overlap < min_overlap && candidate.keyframe != around.back();
  });
  // Reversed before a stable sort, so that of equal overlaps the most recent keyframe comes first.
  std::ranges::reverse(candidates);
  std::ranges::stable_sort(candidates, std::ranges::greater(),
                           [](const Candidate& candidate) { return candidate.preview.overlap; });
  return candidates;
}

Matrix6d information_of(const MotionPrior& prior) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(prior.rotation_sigma_rad),
      Eigen::Vector3d::Constant(prior.translation_sigma_m);
  return sigmas.array().square().inverse().matrix().asDiagonal();
}

/// Puts the candidate that constrains translation best, together with the first `most` − 1 and the
/// prior, in the place after these, if it overlaps the frame enough and halves the standard
/// deviation.
void give_last_place(std::vector<Candidate>& candidates, std::size_t most, double min_overlap,
                     const Matrix6d& prior) {
  Matrix6d others = prior;
  for (std::size_t i = 0; i + 1 < most; ++i) others += candidates[i].preview.information;
  const auto variance_with = [&](const Candidate& last) {
    return spread_of((others + last.preview.information).inverse()).translation_m2;
  };
  constexpr double quarter = 0.25;  // of a variance is half of a standard deviation
  Candidate& last = candidates[most - 1];
  const auto rest = std::span(candidates).subspan(most);
  const auto best = std::ranges::min_element(rest, {}, variance_with);
  if (best->preview.overlap >= min_overlap &&
      variance_with(*best) <= quarter * variance_with(last)) {
    std::swap(last, *best);
  }
}

}  // namespace

std::vector<const Keyframe*> choose_targets(const SurfaceCloud& cloud, const MotionPrior& prior,
                                            std::span<const Keyframe* const> around,
                                            const CameraModel& camera,
                                            const OdometryOptions& options,
                                            const RegistrationOptions& registration) {
  std::vector<Candidate> candidates =
      candidates_of(cloud, prior, around, camera, options.min_target_overlap, registration);
  const auto most = static_cast<std::size_t>(options.targets);
  if (candidates.size() > most) {
    // A single target must be the one that overlaps most.
    if (most > 1) {
      give_last_place(candidates, most, options.min_target_overlap, information_of(prior));
    }
    candidates.resize(most);
  }
  std::vector<const Keyframe*> targets;
  for (const Candidate& candidate : candidates) targets.push_back(candidate.keyframe);
  return targets;
}

}  // namespace tofmap
