// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of drop_steps().
struct StepEdgeLimits {
  /// Angle of incidence of the steepest surface that is not taken for a step, degrees, 0 … 89.9.
  double max_incidence_deg = 80;
  /// Standard deviations of the range errors of both pixels that a step must exceed in addition,
  /// 0 or more.
  double min_sigmas = 3;
};

/// Drops pixels between two steps, with the reason `jump_edge`: along one of 4 directions, the
/// range decreases from one neighbour to the pixel and again from the pixel to the opposite
/// neighbour, both times by more than
///
///   T = tan α ψ min(r, r') + k √(σ² + σ'²)
///
/// with α = `max_incidence_deg`, the angle ψ between the rays, and k = `min_sigmas`
/// (docs/filters.md, equation 5). Neighbours that are invalid or outside the image are ignored. The
/// result does not depend on the order of the pixels. Apply it after unwrapping. Throws UsageError
/// if image and rays differ in size.
RangeImage drop_steps(const RangeImage& image, const PixelRays& rays, const StepEdgeLimits& limits);

}  // namespace tofmap
