// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

/// The wrap counts of pixels relative to their region, and the offset that makes them absolute. The
/// wrap count of a pixel is count + anchor[region].
struct RelativeCounts {
  static constexpr int no_region = -1;

  Image<int> count;   ///< relative wrap count; 0 in pixels without a region
  Image<int> region;  ///< 0 … region_count − 1; no_region where there is no return
  int region_count = 0;
  std::vector<int> anchor;  ///< offset of each region
};

/// Integrates phase jumps into wrap counts along the most certain paths. A spanning forest grows
/// over the pixels (where `valid` is not 0), one jump node after the other; each node sets
/// n(q) = n(p) − i with its most probable configuration i.
///
/// Nodes are taken in the order of the product of their marginal and their own evidence for i
/// (docs/unwrapping.md, equation 9). Marginals alone would not do, since beliefs on loops are
/// overconfident. If all loops of 2 x 2 pixels satisfy the zero-curl constraint, the result does
/// not depend on the paths within regions without holes.
///
/// The anchors make the smallest wrap count of each region 0, as a single frequency does not
/// determine absolute wrap counts.
RelativeCounts integrate_jumps(const JumpProbabilities& marginals,
                               const JumpProbabilities& evidence, const ImageU8& valid);

/// Integrates phase jumps like integrate_jumps(), but with regard to the inter-frequency residual
/// (docs/unwrapping.md, equation 10). Two regions stay separate if the best common fit to their
/// residuals costs more than the two separate fits by more than `objection_share` times the log
/// odds of the jump node between them. So one wrong node cannot shift a whole region.
///
/// The anchor of a region is that at which the residuals of all its pixels together cost least;
/// wrap counts outside 0 … count_a − 1 cost ResidualCost::bound. `nearest` is the best wrap count
/// of each pixel by its own residual (nearest_pair_counts).
RelativeCounts integrate_jumps_with_residual(const JumpProbabilities& marginals,
                                             const JumpProbabilities& evidence,
                                             const ImageU8& valid, const ResidualCost& residual,
                                             const ImageU8& nearest, double objection_share);

}  // namespace tofmap
