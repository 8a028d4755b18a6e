// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of smooth_ranges().
struct SmoothLimits {
  double max_sigmas = 3;       ///< pixels that differ by more noise than that are not averaged
  double tolerance_m = 0.005;  ///< unless they differ by less than that in depth
};

/// Smooths ranges along their rays: each valid pixel becomes the mean of itself and of the pairs of
/// opposite pixels of the 5 x 5 around it that agree with it, weighted by predicted noise and by
/// confidence, and the less the farther they are off. Pairs cancel slant, so planes stay where they
/// are, also at grazing incidence; a pair across an edge disagrees and is left out. sigma_m becomes
/// that of the mean. Pixels that are means already (RangeImage::averaged_px) stay as they are,
/// since their noise is that of their neighbours. No pixel becomes valid or invalid. Throws
/// UsageError if image and rays differ in size.
RangeImage smooth_ranges(const RangeImage& image, const PixelRays& rays,
                         const SmoothLimits& limits);

}  // namespace tofmap
