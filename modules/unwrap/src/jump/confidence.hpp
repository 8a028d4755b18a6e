// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

/// How sure the chosen counts are, 0 … 1, before calibration. 0 where a count is invalid.

/// What neighbours say: the mean marginal probability of the steps to the (up to four)
/// neighbours; 0 for a step of more than one. One half for a pixel that has no neighbour.
ImageF jump_confidence(const ImageU8& counts, const JumpProbabilities& marginals);

/// Neighbours and the pixel's own residual together, their odds multiplied as of independent
/// witnesses.
ImageF jump_and_residual_confidence(const ImageU8& counts, const JumpProbabilities& marginals,
                                    const ResidualCost& residual);

}  // namespace tofmap
