// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/spherical_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tofmap {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

std::optional<double> seen(float range_m) {
  return std::isfinite(range_m) ? std::optional<double>(range_m) : std::nullopt;
}

}  // namespace

SphericalView::SphericalView(std::span<const Eigen::Vector3f> points_m,
                             const Eigen::Vector3d& from_m)
    : from_m_(from_m), nearest_m_(std::size_t{azimuths} * elevations, nothing) {
  for (const Eigen::Vector3f& point : points_m) {
    const Eigen::Vector3d place = point.cast<double>();
    float& nearest = at(bin_of(place));
    nearest = std::min(nearest, static_cast<float>((place - from_m_).norm()));
  }
}

std::optional<double> SphericalView::range_m(const Eigen::Vector3d& point_m) const {
  return seen(at(bin_of(point_m)));
}

std::optional<double> SphericalView::nearest_range_around_m(const Eigen::Vector3d& point_m) const {
  const Bin centre = bin_of(point_m);
  if (!std::isfinite(at(centre))) return std::nullopt;
  float nearest = nothing;
  for (int up = -1; up <= 1; ++up) {
    for (int around = -1; around <= 1; ++around) {
      const Bin bin{(centre.azimuth + around + azimuths) % azimuths,
                    std::clamp(centre.elevation + up, 0, elevations - 1)};
      nearest = std::min(nearest, at(bin));
    }
  }
  return seen(nearest);
}

SphericalView::Bin SphericalView::bin_of(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d ray = point_m - from_m_;
  const double azimuth = std::atan2(ray.y(), ray.x()) / (2 * std::numbers::pi) + 0.5;
  const double elevation = std::atan2(ray.z(), ray.head<2>().norm()) / std::numbers::pi + 0.5;
  return {std::clamp(static_cast<int>(azimuth * azimuths), 0, azimuths - 1),
          std::clamp(static_cast<int>(elevation * elevations), 0, elevations - 1)};
}

float& SphericalView::at(const Bin& bin) {
  return nearest_m_[static_cast<std::size_t>(bin.elevation * azimuths + bin.azimuth)];
}

float SphericalView::at(const Bin& bin) const {
  return nearest_m_[static_cast<std::size_t>(bin.elevation * azimuths + bin.azimuth)];
}

std::vector<Sight> sights(const SphericalView& view, std::span<const Eigen::Vector3f> points_m,
                          const Pose& view_from_points, double slack_m) {
  constexpr double slack_share = 0.02;
  std::vector<Sight> out;
  out.reserve(points_m.size());
  for (const Eigen::Vector3f& point : points_m) {
    const Eigen::Vector3d place = view_from_points * point.cast<double>();
    const double range_m = (place - view.from_m()).norm();
    const double slack = slack_m + slack_share * range_m;
    const std::optional<double> nearest_m = view.nearest_range_around_m(place);
    if (nearest_m && range_m < *nearest_m - slack) {
      out.push_back(Sight::free_space);
      continue;
    }
    const std::optional<double> seen_m = view.range_m(place);
    const bool is_on_surface = seen_m && std::abs(range_m - *seen_m) <= slack;
    out.push_back(is_on_surface ? Sight::surface : Sight::nothing);
  }
  return out;
}

}  // namespace tofmap
