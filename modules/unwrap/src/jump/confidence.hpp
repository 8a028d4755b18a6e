// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

// Confidences of the methods that estimate phase jumps. They rank pixels; they are not calibrated.

/// The confidence by neighbours, 0 … 1: the mean marginal probability of the steps from a pixel to
/// its up to four neighbours. A step of more than one wrap has probability 0. 1/2 for pixels
/// without neighbours, 0 where the wrap count is invalid.
ImageF jump_confidence(const ImageU8& counts, const JumpProbabilities& marginals);

/// The confidence by neighbours and by the pixel's own residual, 0 … 1: the odds of both are
/// multiplied as if they were independent. 0 where the wrap count is invalid.
ImageF jump_and_residual_confidence(const ImageU8& counts, const JumpProbabilities& marginals,
                                    const ResidualCost& residual);

}  // namespace tofmap
