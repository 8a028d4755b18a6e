// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/pixel_label.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofmap {
namespace {

/// Hits that differ by less than this belong to the same surface.
constexpr double surface_gap_m = 0.05;

/// The distance, along `ray`, between its hit and the plane of the hit of the other ray, `plane`.
/// Infinite if the ray does not meet that plane.
double off_plane_m(const SubRay& ray, const SubRay& plane) {
  const Eigen::Vector3d& normal = plane.hit->normal;
  const double to_plane = ray.direction.dot(normal);
  if (to_plane == 0) return std::numeric_limits<double>::infinity();
  const double range_m = plane.hit->range_m * plane.direction.dot(normal) / to_plane;
  return range_m > 0 ? std::abs(range_m - ray.hit->range_m)
                     : std::numeric_limits<double>::infinity();
}

/// The change of range between two rays that are `spacing_rad` apart, on a surface that is slanted
/// as the one that `ray` hits.
double slant_m(const SubRay& ray, double spacing_rad) {
  constexpr double least_cos = 0.01;
  const double cos = std::max(ray.hit->cos_incidence, least_cos);
  return spacing_rad * ray.hit->range_m * std::sqrt(1 - cos * cos) / cos;
}

bool see_two_surfaces(const SubRay& one, const SubRay& other) {
  if (!one.hit || !other.hit) return false;  // a ray without a hit adds no signal
  const double spacing_rad = (one.direction - other.direction).norm();
  const double tolerated_m =
      surface_gap_m + slant_m(one, spacing_rad) + slant_m(other, spacing_rad);
  return std::min(off_plane_m(one, other), off_plane_m(other, one)) > tolerated_m;
}

bool sees_two_surfaces(std::span<const SubRay> rays) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(rays.size())));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool has_right = (i + 1) % side != 0;
    const bool has_below = i + side < rays.size();
    if (has_right && see_two_surfaces(rays[i], rays[i + 1])) return true;
    if (has_below && see_two_surfaces(rays[i], rays[i + side])) return true;
  }
  return false;
}

/// The absolute difference between the range of a phase and `range_m`, modulo the wavelength.
double off_range_m(float phase_cycles, double range_m, double wavelength_m) {
  const double cycles = phase_cycles - range_m / wavelength_m;
  return std::abs(cycles - std::round(cycles)) * wavelength_m;
}

}  // namespace

PixelLabel label_pixel(std::span<const SubRay> rays, float phase_cycles, double wavelength_m,
                       double sigma_m) {
  constexpr double sigmas = 3;
  if (std::isnan(phase_cycles)) return PixelLabel::no_return;
  double off_m = std::numeric_limits<double>::infinity();
  double nearest_m = off_m;
  double farthest_m = 0;
  for (const SubRay& ray : rays) {
    if (!ray.hit) continue;
    off_m = std::min(off_m, off_range_m(phase_cycles, ray.hit->range_m, wavelength_m));
    nearest_m = std::min(nearest_m, ray.hit->range_m);
    farthest_m = std::max(farthest_m, ray.hit->range_m);
  }
  if (sees_two_surfaces(rays)) {
    return off_m > std::max(surface_gap_m, sigmas * sigma_m) ? PixelLabel::flying
                                                             : PixelLabel::mixed;
  }
  // On one surface, every range between the smallest and the largest of the rays is right.
  const double middle_m = (nearest_m + farthest_m) / 2;
  const double spread_m = (farthest_m - nearest_m) / 2;
  return off_range_m(phase_cycles, middle_m, wavelength_m) > noisy_range_m + spread_m
             ? PixelLabel::noisy
             : PixelLabel::right;
}

}  // namespace tofmap
