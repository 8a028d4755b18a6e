// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/frame_halving.hpp>
#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {

/// Makes pixels certain whose blocks of 2 x 2 pixels, which are less noisy, are certain: where the
/// wrap count of the block puts the pixel beside it and the pixel's phases do not contradict. Such
/// a pixel is believed as much as its block. `of_blocks` are those of `blocks`. `mixed` is 1 in
/// mixed pixels, which stay as they are; the other arguments are as in find_own_counts().
void take_block_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                       const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                       const ImageU8& mixed, const NoisyFrame& blocks, const OwnCounts& of_blocks,
                       OwnCounts& own);

}  // namespace tofmap
