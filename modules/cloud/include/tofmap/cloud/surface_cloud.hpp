// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

// PCL's libraries have no instances of its templates for the point types of this project.
#ifndef PCL_NO_PRECOMPILE
#define PCL_NO_PRECOMPILE
#endif
#include <pcl/impl/point_types.hpp>
#include <pcl/point_cloud.h>
#include <pcl/register_point_struct.h>
#include <pcl/types.h>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// A point on a surface, as one frame saw it: position in metres; unit normal towards the camera;
/// standard deviation of the position along the viewing ray (noise and systematic error), metres;
/// standard deviation of the direction of the normal, radians; and the probability that the wrap
/// count is right. For a pixel without a range, the confidence is 0 and all else NaN. A pixel whose
/// plane could not be fitted has a position, but NaN for the normal and its standard deviation.
struct EIGEN_ALIGN16 SurfacePoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  float sigma_m;
  float normal_sigma_rad;
  float confidence;
  PCL_MAKE_ALIGNED_OPERATOR_NEW

  bool has_position() const { return std::isfinite(z); }
  bool has_normal() const { return std::isfinite(normal_z); }
};

/// A cloud organised like the range image it comes from (width x height), in the frame of the
/// camera unless stated otherwise. `is_dense` is false.
using SurfaceCloud = pcl::PointCloud<SurfacePoint>;

/// Options of surface_cloud().
struct CloudOptions {
  /// Half width of the square window of the plane fit, without its centre, 1 … 15 px.
  int window_radius_px = 3;
  /// Largest half width, 1 … 31 px, up to which the window of a pixel grows if noise alone would
  /// make the normal too uncertain.
  int max_window_radius_px = 15;
  /// Largest distance of a neighbour from the plane of a pixel, in standard deviations, 1 … 10.
  double gate_sigmas = 3;
  /// Smallest number of pixels that a plane is fitted to, 3 … 961. A pixel with fewer has no
  /// normal.
  int min_neighbours = 12;
  /// Largest standard deviation of the direction of a normal, 0.001 … 3.2 rad. A pixel above it has
  /// no normal.
  double max_normal_sigma_rad = 0.35;

  static std::vector<OptionField<CloudOptions>> fields();
};

/// Computes the points of a range image, smoothed along their rays, with normals and uncertainty.
///
/// In inverse depth, a plane of any slant is linear in the tangents x and y of a pixel's ray: q =
/// 1/z = a x + b y + c. For each pixel, a plane is fitted to the pixels in its window that lie on
/// the same surface within their predicted noise, weighted by the inverse of their variance. The
/// pixel is moved along its ray onto the plane. Its sigma_m combines the uncertainty of the fit
/// with the systematic_m of the image. Windows grow where noise alone would leave the normal less
/// certain than the options allow. `rays` are those of the camera that took the image. The result
/// does not depend on the number of threads. Throws UsageError if image and rays differ in size.
SurfaceCloud surface_cloud(const RangeImage& image, const PixelRays& rays,
                           const CloudOptions& options);

}  // namespace tofmap

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(tofmap::SurfacePoint,
    (float, x, x)(float, y, y)(float, z, z)
    (float, normal_x, normal_x)(float, normal_y, normal_y)(float, normal_z, normal_z)
    (float, sigma_m, sigma_m)(float, normal_sigma_rad, normal_sigma_rad)
    (float, confidence, confidence))
// clang-format on
