// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

struct LoopOptions {
  bool close = true;
  double radius_m = 3;
  double max_turn_rad = 1;
  int min_gap = 20;
  double min_overlap = 0.35;
  double min_inlier_share = 0.7;
  double drift_share = 0.01;
  double kernel_width = 3;

  static std::vector<OptionField<LoopOptions>> fields();
};

/// What became of the search for a loop.
struct LoopCandidate {
  int from = -1;  ///< id of the earlier keyframe that overlaps most; −1: there is none
  RegistrationResult registration;
  std::optional<PoseEdge> edge;  ///< if the loop was verified
};

/// Looks for an earlier keyframe that sees what `keyframe` sees.
///
/// Candidates are keyframes at least `min_gap` before it, whose cameras stand within `radius_m` and
/// look within `max_turn_rad` of the same direction; the three that overlap most are registered
/// against together, from the pose as it is believed and with a prior as wide as drift allows:
/// `drift_share` of the path between (`path_m`, metres along the path at each keyframe, by id). The
/// loop is there if that is_verified(). Only keyframes before it in `keyframes`, which are in order
/// of their ids, are looked at.
LoopCandidate find_loop(const Keyframe& keyframe, std::span<const Keyframe> keyframes,
                        std::span<const double> path_m, const CameraModel& camera,
                        const LoopOptions& options, const RegistrationOptions& registration);

/// Whether a registration far from where the path came from can be believed: it converged with
/// `min_overlap` and `min_inlier_share`, and leaves no direction to the prior.
bool is_verified(const RegistrationResult& result, const LoopOptions& options);

/// The edge that a registration against `from` measures, with what registration cannot know of its
/// own errors added to its covariance.
PoseEdge edge_of(const Keyframe& from, int to, const RegistrationResult& registration);

}  // namespace tofmap
