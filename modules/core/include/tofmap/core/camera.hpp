// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// A pinhole camera with the distortion model of OpenCV.
///
/// The camera frame is optical: x right, y down, z forward, metres. Pixel coordinates are
/// (u, v) = (column, row); (0, 0) is the centre of the top left pixel.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;                    ///< focal length along u
  double fy_px = 0;                    ///< focal length along v
  double cx_px = 0;                    ///< column of the principal point
  double cy_px = 0;                    ///< row of the principal point
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3, OpenCV's order; all 0: no distortion
};

/// A camera without distortion, with square pixels and the principal point at the image centre.
/// `horizontal_view_rad` is the angle between the left edge of the leftmost pixel and the right
/// edge of the rightmost one, in (0, π).
CameraModel pinhole_camera(double horizontal_view_rad, int width_px, int height_px);

/// Throws InputError if the size or a focal length is not positive, if a number is not finite or
/// is implausible for any camera, or if the distortion folds the image over itself, so that a pixel
/// has no ray.
void validate(const CameraModel& camera);

/// Unit vector from the optical centre through the pixel, in the camera frame. Distortion is
/// inverted by Newton's method; the result is NaN where the distortion has no inverse.
Eigen::Vector3d pixel_ray(const CameraModel& camera, double u_px, double v_px);

/// Pixel coordinates (u, v) of a point in the camera frame. Empty if the point is not in front of
/// the camera, or if the distortion folds the image at that point. The pixel may lie outside the
/// image.
std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector3d& point_m);

/// Unit rays of all pixels, in the camera frame. The ray's z converts radial range to z-depth:
/// `depth_m = range_m * z`. The point of a pixel is `range_m * (x, y, z)`.
struct PixelRays {
  ImageF x;
  ImageF y;
  ImageF z;
};

/// The rays of every pixel of the camera; NaN where pixel_ray() is NaN.
PixelRays pixel_rays(const CameraModel& camera);

/// Converts radial ranges to z-depths. NaN stays NaN.
ImageF depth_from_range(const ImageF& range_m, const PixelRays& rays);

/// Converts z-depths to radial ranges. NaN stays NaN.
ImageF range_from_depth(const ImageF& depth_m, const PixelRays& rays);

}  // namespace tofmap
