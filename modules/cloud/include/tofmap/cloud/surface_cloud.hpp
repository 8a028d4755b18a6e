// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

// The project's own point type: PCL's templates cannot come from its libraries.
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

/// A point on a surface as one frame saw it: position in metres, unit normal towards the
/// camera, standard deviation along the viewing ray (noise and systematic error) and of the
/// normal's direction (radians), probability that its wrap count is right. A pixel without a
/// point is NaN throughout; one without a normal (too few neighbours on its surface) has a
/// position and a NaN normal.
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

/// Organised like the image it comes from (width x height), in the camera frame, unless said
/// otherwise. `is_dense` is false.
using SurfaceCloud = pcl::PointCloud<SurfacePoint>;

struct CloudOptions {
  int window_radius_px = 3;
  int max_window_radius_px = 15;
  double gate_sigmas = 3;
  int min_neighbours = 12;
  double max_normal_sigma_rad = 0.35;

  static std::vector<OptionField<CloudOptions>> fields();
};

/// The points of a range image, smoothed along their rays, with normals and uncertainty.
///
/// In inverse depth a plane is linear in the pixel's tangents, q = 1/z = a x + b y + c, at
/// any slant. Each pixel takes the neighbours in its window that lie on its own surface, as
/// far as their predicted noise can tell, fits that plane with weights from their noise, and
/// is moved along its ray onto it; its sigma_m is the fit's, together with the image's
/// systematic_m. Windows grow where noise alone would leave the normal less certain than the
/// options allow. `rays` are those of the camera that took the image. The result does not depend on
/// the number of threads.
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
