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

/// Once the counts are known, A and B are two measurements of one range: their mean, weighted
/// by the inverse variances, has less noise than either. Where they differ by more than noise
/// explains (a mixed pixel, or a wrong count), or noise is so large that B's own count is not
/// known, A's range stays as it is.
FusedRanges fuse_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                        const BeatLimits& limits, const PhaseNoise& noise);

}  // namespace tofmap
