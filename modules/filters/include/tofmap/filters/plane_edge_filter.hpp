// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of drop_off_planes().
struct PlaneEdgeLimits {
  double max_sigmas = 2.3;    ///< farther off, in the noise of pixel and plane, is off
  double tolerance_m = 0.03;  ///< but not if it is no farther than that in depth
};

/// Drops pixels that lie on no surface around them: flying pixels at jump edges.
///
/// In each of 8 directions, the next two pixels predict this one's inverse depth, in which planes
/// are linear however slanted: q₀ = 2 q₁ − q₂. A pixel of a surface agrees with the predictions
/// of at least three adjacent directions, even at a corner of the surface; a flying pixel at most
/// with those along its edge, where its neighbours fly as well. Predictions come from pixels
/// averaged with their surroundings (averaged_over_pairs), so that noise hides no flying pixel nor
/// makes one.
///
/// On a strip that is two pixels wide, only the two directions along it agree. So a pixel stays,
/// too, if that holds for one beside it as well and both are equally deep.
///
/// What is thinner than two pixels goes. Every pixel is judged by the image as it came in.
/// To be used after unwrapping. Throws UsageError if image and rays differ in size.
RangeImage drop_off_planes(const RangeImage& image, const PixelRays& rays,
                           const PlaneEdgeLimits& limits);

}  // namespace tofmap
