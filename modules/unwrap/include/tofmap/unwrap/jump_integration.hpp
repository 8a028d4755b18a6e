// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/jump_evidence.hpp>

namespace tofmap {

/// Wrap counts of pixels relative to one another, region by region.
struct RelativeCounts {
  static constexpr int no_region = -1;

  Image<int> count;   ///< up to one constant a region; 0 in pixels of no region
  Image<int> region;  ///< 0 … region_count − 1; no_region where there is no return
  int region_count = 0;
};

/// Integrates jumps into counts along the most certain paths: a spanning forest is grown over
/// the pixels (where `valid` is not 0), jump node by jump node; n(q) = n(p) − i for the node's
/// most likely configuration i. Nodes come in the order of the product of their marginal and
/// their own evidence for i: beliefs on loops are too sure of themselves, so those come first
/// that need no persuasion. If no curl is left, the result is independent of the paths within
/// any region without holes.
RelativeCounts integrate_jumps(const JumpProbabilities& marginals,
                               const JumpProbabilities& evidence, const ImageU8& valid);

/// The same, except that the beat may object to any join: two regions stay apart where their
/// joint fit to the beat costs more than both fits apart by more than `objection_share` times
/// the log odds of the jump node between them. So one wrong node cannot carry a whole region.
RelativeCounts integrate_jumps_with_beat(const JumpProbabilities& marginals,
                                         const JumpProbabilities& evidence, const ImageU8& valid,
                                         const BeatCost& beat, double objection_share);

/// A count for each region that makes its relative counts absolute.
struct Anchors {
  std::vector<int> offset;
  std::vector<float> certainty;  ///< probability of the offset against its rivals, 0 … 1
};

/// Anchors every region where the beat of all its pixels together fits best. Counts that leave
/// 0 … count_a − 1 cost as much as the worst beat.
Anchors anchor_by_beat(const RelativeCounts& counts, const BeatCost& beat);

/// Anchors every region with its least count at 0: all that one frequency can say.
Anchors anchor_at_zero(const RelativeCounts& counts);

}  // namespace tofmap
