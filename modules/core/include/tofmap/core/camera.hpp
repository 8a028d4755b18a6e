// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// A pinhole camera with the distortion model of OpenCV (k1 k2 p1 p2 k3).
///
/// The camera frame is optical: x right, y down, z forward, metres. Pixel
/// coordinates are (u, v) = (column, row); (0, 0) is the centre of the top left pixel.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  std::array<double, 5> distortion{};
};

/// A camera without distortion, its centre amid the image, that sees so much from the left side of
/// the leftmost pixels to the right side of the rightmost: below π.
CameraModel pinhole_camera(double horizontal_view_rad, int width_px, int height_px);

/// Throws InputError if the size or focal length is not positive, a number is not finite or beyond
/// what cameras have, or the distortion folds the image over itself (a pixel has no ray).
void validate(const CameraModel& camera);

/// Unit vector from the optical centre through the pixel, in the camera frame.
/// Distortion is inverted by Newton's method; NaN where it has no inverse.
Eigen::Vector3d pixel_ray(const CameraModel& camera, double u_px, double v_px);

/// Pixel coordinates (u, v) of a point in the camera frame. Empty for points that are not
/// in front of the camera; the pixel may lie outside the image.
std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector3d& point_m);

/// Unit rays of all pixels. Radial range and z-depth convert by the ray's z:
/// `depth_m = range_m * z`; the point is `range_m * (x, y, z)`.
struct PixelRays {
  ImageF x;
  ImageF y;
  ImageF z;
};

PixelRays pixel_rays(const CameraModel& camera);

/// z-depth of a radial range image, and back. NaN stays NaN.
ImageF depth_from_range(const ImageF& range_m, const PixelRays& rays);
ImageF range_from_depth(const ImageF& depth_m, const PixelRays& rays);

}  // namespace tofmap
