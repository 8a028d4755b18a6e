// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/surface_cloud.hpp"

#include "plane_windows.hpp"

#include <algorithm>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

SurfacePoint point_on_ray(const PixelRays& rays, int row, int col, float range_m) {
  SurfacePoint point;
  point.x = range_m * rays.x(row, col);
  point.y = range_m * rays.y(row, col);
  point.z = range_m * rays.z(row, col);
  point.data[3] = 1;
  point.normal_x = point.normal_y = point.normal_z = nan;
  point.data_n[3] = 0;
  point.sigma_m = nan;
  point.normal_sigma_rad = nan;
  point.confidence = 0;
  return point;
}

SurfaceCloud empty_cloud(const RangeImage& image) {
  SurfaceCloud cloud;
  cloud.width = static_cast<std::uint32_t>(image.cols());
  cloud.height = static_cast<std::uint32_t>(image.rows());
  cloud.points.resize(image.range_m.size());
  cloud.is_dense = false;
  return cloud;
}

void check_sizes(const RangeImage& image, const PixelRays& rays) {
  if (!same_size(image.range_m, rays.x)) {
    throw UsageError("range image and camera differ in size");
  }
}

/// Standard deviation of the direction of a plane's normal, radians: the larger one of its tilts
/// about both axes.
float normal_sigma_rad(const PlaneRow& planes, std::size_t col, float incidence_cos) {
  // To first order, a tilt by an angle changes the slope of q by angle · q / cos²(incidence).
  const float slope_sigma = std::sqrt(std::max(planes.a_variance[col], planes.b_variance[col]));
  return slope_sigma / planes.q0[col] * incidence_cos * incidence_cos;
}

SurfacePoint surface_point(const PlaneWindows& fits, const PlaneRow& planes,
                           const RangeImage& image, const PixelRays& rays, int row, int col,
                           const CloudOptions& options) {
  SurfacePoint raw = point_on_ray(rays, row, col, image.range_m(row, col));
  raw.sigma_m = static_cast<float>(std::sqrt(image.variance_m2(row, col)));
  raw.confidence = image.confidence(row, col);
  const auto i = static_cast<std::size_t>(col);
  if (!image.valid(row, col) || planes.neighbours[i] == 0 || !(planes.q0[i] > 0)) return raw;

  // q = a (x − x0) + b (y − y0) + q0 = (a, b, q0 − a x0 − b y0) · (x, y, 1). That vector is the
  // normal of the plane, pointing away from the camera, divided by the distance of the plane.
  const float along_z = planes.q0[i] - planes.a[i] * fits.tangent_x(row, col) -
                        planes.b[i] * fits.tangent_y(row, col);
  const Eigen::Vector3f away = Eigen::Vector3f(planes.a[i], planes.b[i], along_z).normalized();
  const float ray_z = rays.z(row, col);
  const float incidence_cos = away.dot(Eigen::Vector3f(rays.x(row, col), rays.y(row, col), ray_z));
  const float tilt_rad = normal_sigma_rad(planes, i, incidence_cos);
  if (!(tilt_rad <= options.max_normal_sigma_rad)) return raw;

  const float range_m = 1 / (planes.q0[i] * ray_z);
  SurfacePoint point = point_on_ray(rays, row, col, range_m);
  point.getNormalVector3fMap() = -away;
  const double noise_m = std::sqrt(planes.q0_variance[i]) * range_m / planes.q0[i];
  point.sigma_m = static_cast<float>(std::hypot(noise_m, image.systematic_m));
  point.normal_sigma_rad = tilt_rad;
  point.confidence = raw.confidence;
  return point;
}

}  // namespace

std::vector<OptionField<CloudOptions>> CloudOptions::fields() {
  return {
      {"window_radius_px", &CloudOptions::window_radius_px, 1, 15, "px",
       "half width of the square window of the plane fit, without its centre"},
      {"max_window_radius_px", &CloudOptions::max_window_radius_px, 1, 31, "px",
       "largest half width, up to which windows grow where noise alone would make the normal too "
       "uncertain"},
      {"gate_sigmas", &CloudOptions::gate_sigmas, 1, 10, "",
       "largest distance of a neighbour from the plane of a pixel, in standard deviations"},
      {"min_neighbours", &CloudOptions::min_neighbours, 3, 961, "",
       "smallest number of pixels that a plane is fitted to; a pixel with fewer has no normal"},
      {"max_normal_sigma_rad", &CloudOptions::max_normal_sigma_rad, 0.001, 3.2, "rad",
       "largest standard deviation of the direction of a normal; a pixel above it has no normal"},
  };
}

SurfaceCloud surface_cloud(const RangeImage& image, const PixelRays& rays,
                           const CloudOptions& options) {
  check_sizes(image, rays);
  const PlaneWindows fits(image, rays, options);
  SurfaceCloud cloud = empty_cloud(image);
  const int rows = static_cast<int>(image.rows());
  const int cols = static_cast<int>(image.cols());
#pragma omp parallel
  {
    PlaneRow planes(static_cast<std::size_t>(cols));
#pragma omp for schedule(dynamic, 4)
    for (int row = 0; row < rows; ++row) {
      fits.fit(row, planes);
      for (int col = 0; col < cols; ++col) {
        cloud.points[row * cols + col] =
            surface_point(fits, planes, image, rays, row, col, options);
      }
    }
  }
  return cloud;
}

}  // namespace tofmap
