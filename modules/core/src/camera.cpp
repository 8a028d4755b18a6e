// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/camera.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/LU>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Limits of plausible cameras. Largest focal length, in units of the longer side of the image.
constexpr double most_sides_of_focal_length = 120;

/// Largest offset of the principal point from the image centre, in units of the side of the image.
/// The limit is wide because the principal point of a cropped image may lie far outside.
constexpr double most_sides_off = 20;

/// Largest factor by which distortion moves an image corner towards or away from the axis.
constexpr double most_distorted = 3;

/// The tangent of a ray's angle to the optical axis.
double off_axis(const Eigen::Vector3d& ray) { return ray.head<2>().norm() / ray.z(); }

bool is_distorted(const CameraModel& camera) {
  for (const double k : camera.distortion) {
    if (k != 0) return true;
  }
  return false;
}

/// Result of the distortion model for one point.
struct Distorted {
  Eigen::Vector2d point;     ///< distorted normalised coordinates
  Eigen::Matrix2d jacobian;  ///< derivative of `point` with respect to the undistorted coordinates
};

Distorted distort(const std::array<double, 5>& k, const Eigen::Vector2d& p) {
  const auto [k1, k2, p1, p2, k3] = k;
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2 * k2 + 3 * r2 * k3);  // d radial / d r²
  Distorted out;
  out.point = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
               y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double cross = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  out.jacobian << radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, cross, cross,
      radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return out;
}

Eigen::Vector2d undistort(const std::array<double, 5>& k, const Eigen::Vector2d& distorted) {
  constexpr int max_iterations = 30;
  constexpr double tolerance = 1e-12;
  Eigen::Vector2d p = distorted;
  for (int i = 0; i < max_iterations; ++i) {
    const Distorted d = distort(k, p);
    // Beyond the fold of the radial polynomial, the iteration would find another branch.
    if (d.jacobian.determinant() <= 0) return Eigen::Vector2d::Constant(nan);
    const Eigen::Vector2d error = d.point - distorted;
    if (error.squaredNorm() < tolerance * tolerance) return p;
    p -= d.jacobian.inverse() * error;
  }
  return Eigen::Vector2d::Constant(nan);
}

}  // namespace

CameraModel pinhole_camera(double horizontal_view_rad, int width_px, int height_px) {
  CameraModel camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = width_px / 2.0 / std::tan(horizontal_view_rad / 2);
  camera.cx_px = (width_px - 1) / 2.0;
  camera.cy_px = (height_px - 1) / 2.0;
  return camera;
}

void validate(const CameraModel& camera) {
  const auto fail = [](const std::string& what) { throw InputError("camera: " + what); };
  if (camera.width_px <= 0 || camera.height_px <= 0) {
    fail("width and height must be positive, got " + std::to_string(camera.width_px) + " x " +
         std::to_string(camera.height_px));
  }
  const bool focal_ok = std::isfinite(camera.fx_px) && std::isfinite(camera.fy_px) &&
                        camera.fx_px > 0 && camera.fy_px > 0;
  if (!focal_ok) fail("fx and fy must be positive");
  const double longer_side_px = std::max(camera.width_px, camera.height_px);
  const double longest_focal_px = most_sides_of_focal_length * longer_side_px;
  if (std::max(camera.fx_px, camera.fy_px) > longest_focal_px) {
    fail("fx and fy must be at most " + std::to_string(std::lround(longest_focal_px)) +
         " pixels, a field of view of half a degree; are they in pixels?");
  }
  const double cx_off_px = std::abs(camera.cx_px - camera.width_px / 2.0);
  const double cy_off_px = std::abs(camera.cy_px - camera.height_px / 2.0);
  if (!(cx_off_px <= most_sides_off * camera.width_px &&
        cy_off_px <= most_sides_off * camera.height_px)) {
    fail("cx and cy must lie near the image; are they in pixels?");
  }
  for (const double k : camera.distortion) {
    if (!std::isfinite(k)) fail("distortion must be five finite numbers: k1 k2 p1 p2 k3");
  }
  CameraModel pinhole = camera;
  pinhole.distortion = {};
  // The corners are the farthest from the axis: if they have rays, all pixels have rays.
  for (const double u : {0.0, camera.width_px - 1.0}) {
    for (const double v : {0.0, camera.height_px - 1.0}) {
      const Eigen::Vector3d ray = pixel_ray(camera, u, v);
      if (!ray.allFinite()) {
        fail("the distortion coefficients fold the image: its corners have no viewing ray");
      }
      const double ratio = off_axis(ray) / off_axis(pixel_ray(pinhole, u, v));
      if (ratio > most_distorted || ratio < 1 / most_distorted) {
        fail(
            "the distortion coefficients move the image corners farther than any lens does; "
            "are they k1 k2 p1 p2 k3?");
      }
    }
  }
}

Eigen::Vector3d pixel_ray(const CameraModel& camera, double u_px, double v_px) {
  Eigen::Vector2d p((u_px - camera.cx_px) / camera.fx_px, (v_px - camera.cy_px) / camera.fy_px);
  if (is_distorted(camera)) p = undistort(camera.distortion, p);
  return Eigen::Vector3d(p.x(), p.y(), 1).normalized();
}

std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector3d& point_m) {
  if (!(point_m.z() > 0)) return std::nullopt;
  Eigen::Vector2d p = point_m.head<2>() / point_m.z();
  if (is_distorted(camera)) {
    const Distorted d = distort(camera.distortion, p);
    if (d.jacobian.determinant() <= 0) return std::nullopt;
    p = d.point;
  }
  return Eigen::Vector2d(camera.fx_px * p.x() + camera.cx_px, camera.fy_px * p.y() + camera.cy_px);
}

PixelRays pixel_rays(const CameraModel& camera) {
  PixelRays rays;
  for (ImageF* plane : {&rays.x, &rays.y, &rays.z}) {
    plane->resize(camera.height_px, camera.width_px);
  }
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3f ray = pixel_ray(camera, u, v).cast<float>();
      rays.x(v, u) = ray.x();
      rays.y(v, u) = ray.y();
      rays.z(v, u) = ray.z();
    }
  }
  return rays;
}

ImageF depth_from_range(const ImageF& range_m, const PixelRays& rays) { return range_m * rays.z; }

ImageF range_from_depth(const ImageF& depth_m, const PixelRays& rays) { return depth_m / rays.z; }

}  // namespace tofmap
