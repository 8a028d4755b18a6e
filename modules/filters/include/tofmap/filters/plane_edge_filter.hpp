// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of drop_off_planes(), in standard deviations of the noise of pixel and plane.
struct PlaneEdgeLimits {
  double max_sigmas = 3.2;       ///< farther off is off, where no step is
  double max_edge_sigmas = 1.5;  ///< the same at a step between two surfaces
  double tolerance_m = 0.03;     ///< what is no farther off than that, in depth, is not off
};

/// Drops pixels that lie on no surface around them: flying pixels at jump edges.
///
/// In each of 8 directions, the next two pixels predict this one's inverse depth, in which planes
/// are linear however slanted: q₀ = 2 q₁ − q₂. A pixel of a surface agrees with the predictions
/// of at least three adjacent directions, even at a corner of the surface; a flying pixel at most
/// with those along its edge, where its neighbours fly as well. Predictions come from pixels
/// averaged with their surroundings (averaged_over_pairs), so that noise hides no flying pixel nor
/// makes one. Where opposite sides of the pixel are two surfaces, it must agree more closely.
///
/// Both the range from both frequencies and the range from A alone must agree: the two frequencies
/// of a mixed pixel are seldom off by the same. What a frequency is off by all over a surface
/// changes nothing, since only differences between pixels are compared.
///
/// On a strip that is two pixels wide, only the two directions along it agree. So a pixel stays,
/// too, if that holds for one beside it as well and both are equally deep. What agrees only with
/// pixels that are dropped is dropped in a second pass; what is as deep as two pixels that are kept
/// is taken back at last.
///
/// What is thinner than two pixels goes. To be used after unwrapping. Throws UsageError if image,
/// frame and rays differ in size.
RangeImage drop_off_planes(const RangeImage& image, const DualFrequencyFrame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PlaneEdgeLimits& limits);

}  // namespace tofmap
