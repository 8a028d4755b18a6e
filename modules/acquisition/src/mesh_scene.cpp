// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// A camera path through a mesh that nothing is known about.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <tofmap/acquisition/ray_scene.hpp>
#include <tofmap/acquisition/scenes.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double least_clearance_m = 0.6;
constexpr int loop_waypoints = 16;

struct FreePlace {
  Vector3d position;
  double clearance_m = 0;
};

/// How high above the ground below it a place lies; nothing outside or without ground.
std::optional<double> height_m(const RayScene& rays, const Vector3d& place, double limit_m) {
  const auto ground = rays.cast(place, -Vector3d::UnitZ(), limit_m);
  if (!ground) return std::nullopt;
  return ground->range_m;
}

/// The place with the most room around it, at eye height above the floor, of a regular grid.
std::optional<FreePlace> widest_place(const RayScene& rays, const Eigen::AlignedBox3d& box) {
  const Vector3d size = box.sizes();
  const double step = std::max(0.25, std::max(size.x(), size.y()) / 60);
  const double eye = std::min(1.5, 0.5 * size.z());
  const double z = box.min().z() + eye;
  std::optional<FreePlace> best;
  for (double x = box.min().x() + step; x < box.max().x(); x += step) {
    for (double y = box.min().y() + step; y < box.max().y(); y += step) {
      const Vector3d place(x, y, z);
      const auto height = height_m(rays, place, size.z());
      if (!height || *height < 0.5 * eye) continue;
      const double clearance = rays.clearance_m(place, size.norm());
      if (clearance < least_clearance_m) continue;
      if (!best || clearance > best->clearance_m) best = FreePlace{place, clearance};
    }
  }
  return best;
}

CameraPath loop_inside(const FreePlace& place) {
  // Half the free radius, so that the other half keeps the camera off the surfaces.
  const double radius = std::max(0.15, 0.5 * place.clearance_m);
  std::vector<Waypoint> waypoints;
  for (int i = 0; i < loop_waypoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / loop_waypoints;
    const Vector3d outwards(std::cos(angle), std::sin(angle), 0);
    waypoints.push_back({place.position + radius * outwards, outwards - Vector3d(0, 0, 0.05)});
  }
  return {std::move(waypoints), true};
}

CameraPath orbit_around(const Eigen::AlignedBox3d& box) {
  const double radius = 1.5 * box.sizes().norm();
  std::vector<Waypoint> waypoints;
  for (int i = 0; i < loop_waypoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / loop_waypoints;
    const Vector3d outwards(std::cos(angle), std::sin(angle), 0.3);
    waypoints.push_back(look_at(box.center() + radius * outwards, box.center()));
  }
  return {std::move(waypoints), true};
}

}  // namespace

Scene make_mesh_scene(const std::filesystem::path& file) {
  Scene scene;
  scene.name = file.stem().string();
  scene.surface = read_mesh(file);
  scene.min_frames = 150;
  const Eigen::AlignedBox3d box = bounds(scene.surface);
  const RayScene rays(scene.surface);
  if (const auto place = widest_place(rays, box)) {
    scene.path = loop_inside(*place);
    scene.max_range_m = box.sizes().norm();
  } else {
    scene.path = orbit_around(box);
    scene.max_range_m = 2.5 * box.sizes().norm();
  }
  return scene;
}

}  // namespace tofmap
