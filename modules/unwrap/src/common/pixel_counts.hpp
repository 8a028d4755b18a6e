// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap {

// What each pixel tells by itself, without its neighbours. Phases must be NaN at all frequencies
// where one of them has no return; wrap counts are invalid there.

/// The wrap count that fits all frequencies best in each pixel. With two frequencies it is that of
/// nearest_pair_counts(). With more, the squared residual of each frequency to the mean of those
/// before it is weighted by the noise of both. With one frequency, all wrap counts are 0.
ImageU8 nearest_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma);

/// The probability of the given wrap counts, normalised over all wrap counts: exp(−cost), with the
/// cost of each frequency bounded like ResidualCost. 0 where the wrap count is invalid. With one
/// frequency, all wrap counts are equally probable.
ImageF count_probability(const Frame& frame, const ImageU8& counts, const UnwrapLimits& limits,
                         const PhaseSigma& sigma);

}  // namespace tofmap
