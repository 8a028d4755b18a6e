// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// Ranges from both frequencies and the standard deviation of their noise; metres, of the frame's
/// size, NaN where the wrap count is invalid.
struct FusedRanges {
  ImageF range_m;
  ImageF sigma_m;
};

/// Fuses the ranges of both frequencies into their mean, weighted by inverse variances, which has
/// less noise than either range.
///
/// The result is A's range alone
/// - where the noise is so large that it may carry B across a wrap boundary, or B did not see A's
///   surface (MatchedExposure::unseen_sigma_cycles);
/// - where the residual exceeds residual_agreement_sigmas standard deviations of noise and
///   `residual_sigma_m` together: a mixed pixel, or a wrong wrap count;
/// - where noise makes the mean negative.
///
/// B must be matched to A (MatchedExposure): systematic errors and motion are already removed from
/// its phases. `counts` are the wrap counts of A, `sigma` is the noise of both phases, and
/// `residual_sigma_m` is the standard deviation of the residual besides noise.
FusedRanges fuse_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                        const UnwrapLimits& limits, const PhaseSigma& sigma,
                        double residual_sigma_m);

}  // namespace tofmap
