// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// What the plane fits of one image share: planes of inverse depth q = 1/z, of its variance,
/// and of the pixels' tangents (x/z, y/z). Invalid pixels have a NaN q.
struct InverseDepthImage {
  ImageF q;
  ImageF variance;
  ImageF tangent_x;
  ImageF tangent_y;
};

InverseDepthImage inverse_depth_image(const RangeImage& image, const PixelRays& rays);

/// The plane q = q0 + a (x − x0) + b (y − y0) through the surface at a pixel (x0, y0).
struct InverseDepthPlane {
  int neighbours = 0;  ///< pixels that take part; below the minimum: no plane
  float q0 = 0;
  float a = 0;
  float b = 0;
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();  ///< of (q0, a, b)
};

/// Fits the plane at a valid pixel to the neighbours on its own surface.
InverseDepthPlane fit_plane(const InverseDepthImage& image, int row, int col,
                            const CloudOptions& options);

}  // namespace tofmap
