// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {

/// The wrap counts of pixels by their own phases, and the pixels in which they are certain.
struct OwnCounts {
  ImageU8 count;    ///< the most likely wrap count; anything where there is no return
  ImageU8 certain;  ///< 1 where `count` is certain, else 0
  /// Belief in all other wrap counts together, relative to that in `count` (equation 15); only
  /// where `certain` is 1.
  ImageF odds_against;
  ImageF cost;  ///< of `count` by the pixel's own phases, nats
};

/// Finds the pixels of a frame of at least two frequencies whose wrap counts need no belief
/// propagation (docs/unwrapping.md, 'Pixels that are certain by themselves'): their own phases are
/// clear, and so are those of at least three neighbours, whose ranges agree with theirs. Phases
/// must be NaN at all frequencies where one of them has no return. `mixed` is 1 in mixed pixels.
OwnCounts find_own_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                          const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                          const ImageU8& mixed);

}  // namespace tofmap
