// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

/// Ranges from all frequencies and the standard deviation of their noise; metres, of the frame's
/// size, NaN where the wrap count is invalid.
struct FusedRanges {
  ImageF range_m;
  ImageF sigma_m;
};

/// Fuses the ranges of all frequencies into their mean, weighted by inverse variances, which has
/// less noise than any of them. Frequencies are added one after the other, the longest wavelength
/// first, each to the mean of those before.
///
/// A frequency f is left out
/// - where the noise is so large that it may carry f across a wrap boundary, or f did not see the
///   surface of the first frequency (MatchedExposure::unseen_sigma_cycles);
/// - where its residual to the mean so far exceeds residual_agreement_sigmas standard deviations of
///   noise and `residual_sigma_m` together: a mixed pixel, or a wrong wrap count;
/// - where noise makes the mean negative.
///
/// The other frequencies must be matched to the first one (MatchedExposure): systematic errors and
/// motion are already removed from their phases. `counts` are the wrap counts of the first
/// frequency, `sigma` is the noise of the phases, and `residual_sigma_m` has for each frequency the
/// standard deviation of its residual to the first one besides noise.
FusedRanges fuse_ranges(const Frame& frame, const ImageU8& counts, const UnwrapLimits& limits,
                        const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m);

}  // namespace tofmap
