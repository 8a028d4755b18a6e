// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "furnishing_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double carried_below_m = 2.5;  ///< above the floor
constexpr double path_gap_m = 0.5;
constexpr double obstacle_m = 0.05;  ///< above the floor

/// The height of the floor beneath a place: the lowest surface down to the reach of a carried
/// camera, since there may be furniture in between, or else the first surface beneath.
std::optional<double> floor_under_m(const RayScene& rays, const Vector3d& place_m) {
  constexpr double limit_m = 100;
  constexpr double beyond_m = 0.001;
  std::optional<double> floor_m;
  Vector3d from = place_m;
  while (const auto hit = rays.cast(from, -Vector3d::UnitZ(), limit_m)) {
    const double height_m = from.z() - hit->range_m;
    if (floor_m && place_m.z() - height_m > carried_below_m) break;
    floor_m = height_m;
    from.z() = height_m - beyond_m;
  }
  return floor_m;
}

std::optional<double> median_floor_m(const RayScene& rays, const std::vector<Pose>& views) {
  std::vector<double> floors_m;
  for (const Pose& view : views) {
    const auto floor_m = floor_under_m(rays, view.translation());
    if (floor_m) floors_m.push_back(*floor_m);
  }
  if (floors_m.empty()) return std::nullopt;
  const auto middle = floors_m.begin() + static_cast<std::ptrdiff_t>(floors_m.size() / 2);
  std::ranges::nth_element(floors_m, middle);
  return *middle;
}

}  // namespace

SampledPath sampled(const CameraPath& path) {
  constexpr double spacing_m = 0.04;
  constexpr int per_segment = 50;
  constexpr int views = 60;
  SampledPath samples;
  const int count = static_cast<int>(path.end()) * per_segment;
  for (int i = 0; i <= count; ++i) {
    const Vector3d place_m = path.pose_at(path.end() * i / count).translation();
    const bool is_far = samples.places_m.empty() ||
                        (place_m - samples.places_m.back()).norm() >= spacing_m || i == count;
    if (is_far) samples.places_m.push_back(place_m);
  }
  for (int i = 0; i < views; ++i) {
    samples.views.push_back(path.pose_at(path.end() * i / (views - 1)));
  }
  return samples;
}

FurnishingSpace::FurnishingSpace(const TriangleMesh& surface, const SampledPath& path)
    : surface_(surface), path_(path), rays_(surface), floor_m_(median_floor_m(rays_, path.views)) {}

std::optional<double> FurnishingSpace::floor_beneath_m(const UprightBox& box) const {
  constexpr double reach_m = 0.3;
  constexpr double evenness_m = 0.02;
  if (!floor_m_) return std::nullopt;
  const auto height_at = [&](double x, double y) -> std::optional<double> {
    Vector3d from = box.world_m({x * box.half_m.x(), y * box.half_m.y(), 0});
    from.z() = *floor_m_ + reach_m;
    const auto hit = rays_.cast(from, -Vector3d::UnitZ(), 2 * reach_m);
    return hit ? std::optional(from.z() - hit->range_m) : std::nullopt;
  };
  const auto middle_m = height_at(0, 0);
  if (!middle_m) return std::nullopt;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      const auto height_m = height_at(x, y);
      if (!height_m || std::abs(*height_m - *middle_m) > evenness_m) return std::nullopt;
    }
  }
  constexpr double per_m = 1e4;  // rays have single precision
  return std::round(*middle_m * per_m) / per_m;
}

bool FurnishingSpace::is_clear_of_path(const UprightBox& box) const {
  return std::ranges::all_of(path_.places_m, [&](const Vector3d& place_m) {
    const bool is_carried = floor_m_ && place_m.z() - *floor_m_ < carried_below_m;
    return (is_carried ? horizontal_gap_m(box, place_m) : gap_m(box, place_m)) >= path_gap_m;
  });
}

bool FurnishingSpace::is_free(const UprightBox& box) const {
  constexpr double margin_m = 0.02;
  UprightBox space = box;
  space.half_m += Vector3d(margin_m, margin_m, (margin_m - obstacle_m) / 2);
  space.centre_m.z() += (margin_m + obstacle_m) / 2;
  const double radius_m = space.half_m.norm();
  return std::ranges::none_of(surface_.triangles, [&](const auto& triangle) {
    std::array<Vector3d, 3> corners;
    Eigen::AlignedBox3d around;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = surface_.vertices[triangle[i]].template cast<double>();
      around.extend(corners[i]);
    }
    return around.exteriorDistance(space.centre_m) <= radius_m && intersects(space, corners);
  });
}

bool FurnishingSpace::sees(const Pose& world_from_camera, const Vector3d& point_m) const {
  // The view of an ordinary camera, so that furniture is the same for all cameras.
  constexpr double half_width = 0.577;
  constexpr double half_height = 0.45;
  constexpr double near_m = 0.3;
  constexpr double far_m = 15;
  constexpr double before_surface_m = 0.03;
  const Vector3d in_camera = world_from_camera.inverse() * point_m;
  const double range_m = in_camera.norm();
  const bool is_in_view = in_camera.z() > near_m && range_m < far_m &&
                          std::abs(in_camera.x()) < half_width * in_camera.z() &&
                          std::abs(in_camera.y()) < half_height * in_camera.z();
  if (!is_in_view) return false;
  const Vector3d from = world_from_camera.translation();
  return !rays_.cast(from, (point_m - from) / range_m, range_m - before_surface_m);
}

double FurnishingSpace::seen_share(const std::vector<Vector3d>& points_m) const {
  constexpr int wanted_views = 2;
  if (points_m.empty()) return 0;
  const auto seen = std::ranges::count_if(points_m, [&](const Vector3d& point_m) {
    int views = 0;
    for (const Pose& view : path_.views) {
      views += sees(view, point_m) ? 1 : 0;
      if (views == wanted_views) return true;
    }
    return false;
  });
  return static_cast<double>(seen) / static_cast<double>(points_m.size());
}

}  // namespace tofmap
