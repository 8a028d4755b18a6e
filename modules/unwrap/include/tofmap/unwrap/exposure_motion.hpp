// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// How the camera moved between the exposures of A and B, in the camera frame of A: to
/// `translation_m`, and by the rotation vector `rotation_rad`.
struct ExposureMotion {
  Eigen::Vector3f translation_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f rotation_rad = Eigen::Vector3f::Zero();
  int pixels = 0;  ///< that took part in the estimate; 0: too few, and no motion is known
};

/// Estimates the motion from one frame: for a camera that moves to t and turns by ω, the range
/// of a pixel with the ray u on a surface with the normal n shrinks by
///
///   g · t + (X × g) · ω,   g = n / (n · u),   X = range u
///
/// which is what A's range minus B's shows besides noise (docs/unwrapping.md, equation 17). Least
/// squares over pixels on smooth surfaces, weighted by their noise and robust against those that
/// saw another surface at B.
/// `residual_m` is A's range minus B's, `sigma_m` its standard deviation; NaN where unknown. An
/// offset between the frequencies looks like a motion along the view and is taken for one.
ExposureMotion estimate_exposure_motion(const ImageF& range_m, const ImageF& residual_m,
                                        const ImageF& sigma_m, const PixelRays& rays);

/// By how much the motion makes each pixel's range shrink from A to B, metres. Where a pixel has no
/// smooth surroundings, as for a surface that faces it.
ImageF range_shrinkage_m(const ExposureMotion& motion, const ImageF& range_m,
                         const PixelRays& rays);

}  // namespace tofmap
