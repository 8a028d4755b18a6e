// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// How far a pixel may deviate from the planes around it in drop_off_planes(). Deviations are in
/// depth; standard deviations are those of pixel and prediction together.
struct PlaneEdgeLimits {
  double max_sigmas = 3.2;       ///< standard deviations, for pixels that are not at a step
  double max_edge_sigmas = 1.5;  ///< standard deviations, for pixels at a step between surfaces
  double tolerance_m = 0.03;     ///< always accepted; added to the other limits in quadrature
};

/// Drops pixels that lie on none of the surfaces around them, that is, flying pixels at jump edges.
/// They get the reason `jump_edge`. docs/filters.md has the equations.
///
/// In each of 8 directions, the next two pixels predict the inverse depth of the pixel,
/// q₀ = 2 q₁ − q₂: planes are linear in inverse depth, however slanted they are. A pixel of a
/// surface agrees with the predictions of at least three adjacent directions, even at a corner of
/// the surface. A flying pixel agrees at most with the two directions along its edge, where its
/// neighbours are flying pixels as well. Predictions are made from averages over the pixels around
/// (averaged_over_pairs()), so that noise neither hides nor creates a flying pixel. The limit is
/// stricter where the pixel is between two surfaces.
///
/// Both the range from both frequencies and the range from A alone must agree, since the errors of
/// the two frequencies at a mixed pixel are seldom equal. An error of a frequency that is the same
/// all over a surface has no effect, since only differences between pixels are compared.
///
/// On a strip that is two pixels wide, only the two directions along the strip agree. So a pixel
/// also stays if the same is true of a pixel beside it and both have the same depth. A second pass
/// drops pixels at steps that agree only with dropped pixels. Finally, a pixel that has the same
/// depth as two kept neighbours is restored.
///
/// Objects that are thinner than two pixels are lost. Apply it after unwrapping. Throws UsageError
/// if image, frame and rays differ in size.
RangeImage drop_off_planes(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PlaneEdgeLimits& limits);

}  // namespace tofmap
