// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of smooth_ranges().
struct SmoothLimits {
  double max_sigmas = 3;       ///< largest difference of averaged pixels, standard deviations
  double tolerance_m = 0.005;  ///< always accepted, in depth; added to max_sigmas in quadrature
};

/// Smooths ranges along their rays. Each valid pixel gets the mean of its own inverse depth and of
/// the pairs of opposite pixels, one and two pixels away in 4 directions, that agree with it.
/// Weights follow predicted noise and confidence, and fall with the difference from the pixel.
///
/// The mean of a pair does not depend on the slant, so planes are not displaced, not even at
/// grazing incidence. A pair across an edge disagrees and is left out. sigma_m becomes the standard
/// deviation of the mean. Pixels that are averages already (RangeImage::averaged_px above 1) are
/// not changed, since they share the noise of their neighbours. No pixel becomes valid or invalid.
/// Throws UsageError if image and rays differ in size.
RangeImage smooth_ranges(const RangeImage& image, const PixelRays& rays,
                         const SmoothLimits& limits);

}  // namespace tofmap
