// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// One range a pixel from both frequencies, with its standard deviation; metres, NaN where the
/// count is invalid.
struct FusedRanges {
  ImageF range_m;
  ImageF sigma_m;
};

/// The ranges of both frequencies in one: their mean, weighted by the inverse variances, which has
/// less noise than either. It is A's alone where noise may carry B across a wrap boundary, where B
/// did not see what A sees, and where the two differ by more than residual_agreement_sigmas of
/// noise and `residual_sigma_m`: a pixel of two surfaces, or a wrong count. B is matched to A: what
/// the camera's errors and motion make of the residual is gone from its phases.
FusedRanges fuse_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                        const UnwrapLimits& limits, const PhaseSigma& sigma,
                        double residual_sigma_m);

}  // namespace tofmap
