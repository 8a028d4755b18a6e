// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of drop_steps().
struct StepEdgeLimits {
  double max_incidence_rad = 1.396;  ///< surfaces seen at more than this (80°) look like steps
  double min_sigmas = 3;             ///< steps below that, in the noise of both pixels, are none
};

/// Drops pixels between two steps: in one of 4 directions the range falls from one neighbour to the
/// pixel, and again to the opposite neighbour, by more than a surface at `max_incidence_rad` falls
/// from pixel to pixel at that range, and more than noise. Neighbours outside the image or invalid
/// say nothing. Every pixel is judged by the image as it came in. To be used after unwrapping.
/// Throws UsageError if image and rays differ in size.
RangeImage drop_steps(const RangeImage& image, const PixelRays& rays, const StepEdgeLimits& limits);

}  // namespace tofmap
