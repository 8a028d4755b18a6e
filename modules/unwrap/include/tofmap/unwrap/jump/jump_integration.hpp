// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

/// Wrap counts of pixels relative to one another, region by region, and what makes them absolute.
struct RelativeCounts {
  static constexpr int no_region = -1;

  Image<int> count;   ///< up to one constant a region; 0 in pixels of no region
  Image<int> region;  ///< 0 … region_count − 1; no_region where there is no return
  int region_count = 0;
  std::vector<int> anchor;  ///< for each region what to add to its counts
};

/// Integrates jumps into counts along the most certain paths: a spanning forest is grown over
/// the pixels (where `valid` is not 0), jump node by jump node; n(q) = n(p) − i for the node's
/// most likely configuration i. Nodes come in the order of the product of their marginal and
/// their own evidence for i: beliefs on loops are too sure of themselves, so those come first
/// that need no persuasion. If no curl is left, the result is independent of the paths within
/// any region without holes. Regions are anchored with their least count at 0: all that one
/// frequency can say.
RelativeCounts integrate_jumps(const JumpProbabilities& marginals,
                               const JumpProbabilities& evidence, const ImageU8& valid);

/// The same, except that the residual may object to any join: two regions stay apart where their
/// joint fit to the residual costs more than both fits apart by more than `objection_share` times
/// the log odds of the jump node between them. So one wrong node cannot carry a whole region.
/// Regions are anchored where the residual of all their pixels together fits best; counts that
/// leave 0 … count_a − 1 cost as much as the worst residual. `nearest` is the best count of each
/// pixel by itself (nearest_pair_counts).
RelativeCounts integrate_jumps_with_residual(const JumpProbabilities& marginals,
                                             const JumpProbabilities& evidence,
                                             const ImageU8& valid, const ResidualCost& residual,
                                             const ImageU8& nearest, double objection_share);

}  // namespace tofmap
