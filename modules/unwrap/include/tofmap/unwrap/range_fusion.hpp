// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/phase_noise.hpp>

namespace tofmap {

/// One range a pixel from both frequencies, with its standard deviation; metres, NaN where the
/// count is invalid.
struct FusedRanges {
  ImageF range_m;
  ImageF sigma_m;
};

/// Two measurements of one range, once the counts are known.
struct RangePair {
  ImageF range_a_m;   ///< NaN where the count is invalid
  ImageF residual_m;  ///< A's range minus B's; NaN where B's own count is not sure
  ImageF variance_a_m2;
  ImageF variance_b_m2;
};

/// The ranges of both frequencies. Where noise may carry B across a wrap boundary, or the two
/// differ by more than noise explains (a mixed pixel, or a wrong count), there is no residual.
RangePair pair_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                      const BeatLimits& limits, const PhaseSigma& sigma);

/// Their mean, weighted by the inverse variances: less noise than either. A's range alone where
/// there is no residual. `shrinkage_m` is what the range lost from A's exposure to B's; it may be
/// empty if nothing moved.
FusedRanges fuse_ranges(const RangePair& pair, const ImageF& shrinkage_m);

}  // namespace tofmap
