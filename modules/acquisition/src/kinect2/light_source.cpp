// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/light_source.hpp"

#include <cmath>
#include <string>

#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {

double range_from_half_path(double half_path_m, const Eigen::Vector3d& ray,
                            const Eigen::Vector3d& source_m) {
  const double path_m = 2 * half_path_m;
  if (!(path_m > source_m.norm())) return nan;
  if (std::isinf(path_m)) return path_m;
  return (path_m * path_m - source_m.squaredNorm()) / (2 * (path_m - ray.dot(source_m)));
}

double half_path_from_range(double range_m, const Eigen::Vector3d& ray,
                            const Eigen::Vector3d& source_m) {
  if (!(range_m >= 0)) return nan;
  return ((range_m * ray - source_m).norm() + range_m) / 2;
}

ImageF half_path_offset(const PixelRays& rays, const Eigen::Vector3d& source_m, double range_m) {
  if (!(range_m > 0)) {
    throw UsageError("range_m of an offset of the light's path must be above 0, got " +
                     std::to_string(range_m));
  }
  ImageF offset_m(rays.z.rows(), rays.z.cols());
  for (Eigen::Index i = 0; i < offset_m.size(); ++i) {
    // Normalised, because the length of a ray of floats differs from 1 by up to 10^-7.
    const Eigen::Vector3d ray =
        Eigen::Vector3d(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]).normalized();
    offset_m.data()[i] = static_cast<float>(
        std::isinf(range_m) ? -ray.dot(source_m) / 2
                            : half_path_from_range(range_m, ray, source_m) - range_m);
  }
  return offset_m;
}

ImageF shifted_phase(const ImageF& phase, const ImageF& offset_m, double wavelength_m) {
  if (!same_size(phase, offset_m)) {
    throw UsageError("phases and offsets must have the same size, got " +
                     std::to_string(phase.cols()) + " x " + std::to_string(phase.rows()) + " and " +
                     std::to_string(offset_m.cols()) + " x " + std::to_string(offset_m.rows()));
  }
  if (!(wavelength_m > 0)) {
    throw UsageError("wavelength_m must be above 0, got " + std::to_string(wavelength_m));
  }
  const ImageF cycles = phase - offset_m / static_cast<float>(wavelength_m);
  const ImageF shifted = cycles - cycles.floor();
  return (shifted >= 1).select(0.0F, shifted);  // a whole cycle after rounding is phase 0
}

}  // namespace tofmap::kinect2
