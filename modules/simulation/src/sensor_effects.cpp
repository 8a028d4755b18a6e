// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sensor_effects.hpp"

#include "noise.hpp"
#include "pixel_signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// Distance from a surface at which rays start and end, so that they do not meet that surface.
constexpr double off_surface_m = 1e-3;

/// The i-th of n points that are spread evenly over the unit square (rank-1 lattice), shifted by
/// `shift` with wrap-around.
Eigen::Vector2d spread_point(int i, int n, const Eigen::Vector2d& shift) {
  const double golden = std::numbers::phi - 1;
  const Eigen::Vector2d point((i + 0.5) / n + shift.x(), i * golden + shift.y());
  return point - point.array().floor().matrix();
}

/// Maps a point of the unit square to a direction in the hemisphere around the unit vector
/// `normal`. Uniform points give a cosine-weighted distribution.
Eigen::Vector3d around(const Eigen::Vector3d& normal, const Eigen::Vector2d& point) {
  const double sine = std::sqrt(point.x());
  const double turn = rad_per_cycle * point.y();
  const Eigen::Vector3d side = normal.unitOrthogonal();
  return sine * std::cos(turn) * side + sine * std::sin(turn) * normal.cross(side) +
         std::sqrt(1 - point.x()) * normal;
}

/// The charge of sample k, at k quarters of the period: dark charge, the level of the light, and
/// the correlation function with its third harmonic (docs/simulator.md, equation 5).
double charge(const PixelLight& light, int k, const SensorEffects& effects) {
  const double quarter = k * std::numbers::pi / 2;
  const double correlation =
      (light.first * std::polar(1.0, -quarter)).real() +
      effects.harmonic * (light.third * std::polar(1.0, -3 * quarter)).real();
  const double charge = effects.dark_level + light.level + correlation;
  return effects.full_well > 0 ? std::min(charge, effects.full_well) : charge;
}

}  // namespace

PixelLight light_from(double strength, double range_m, double wavelength_m) {
  const std::complex<double> turn = std::polar(1.0, rad_per_cycle * range_m / wavelength_m);
  return {strength * turn, strength * (turn * turn * turn), strength};
}

SensorEffects sensor_effects(const SimulatorOptions& options, const Modulation& modulation) {
  return {.harmonic = rad_per_cycle * options.wiggle_m / modulation.wavelength_m(0),
          .dark_level = options.dark_level,
          .full_well = options.full_well};
}

std::complex<double> demodulate(const std::array<PixelLight, 4>& samples,
                                const SensorEffects& effects) {
  std::array<double, 4> charges{};
  for (int k = 0; k < 4; ++k) {
    charges[static_cast<std::size_t>(k)] = charge(samples[static_cast<std::size_t>(k)], k, effects);
  }
  return {(charges[0] - charges[2]) / 2, (charges[1] - charges[3]) / 2};
}

double dark_noise_sigma(const SensorEffects& effects) {
  // The variance of the shot noise of a sample equals its dark charge. A component is half the
  // difference of two samples.
  return std::sqrt(effects.dark_level / 2);
}

bool Lamp::shines_on(const Eigen::Vector3d& point_m) const {
  const auto pixel = project(camera, world_from_camera.inverse() * point_m);
  return pixel && pixel->x() > -0.5 && pixel->x() < camera.width_px - 0.5 && pixel->y() > -0.5 &&
         pixel->y() < camera.height_px - 0.5;
}

PixelLight indirect_light(const SceneAtTime& scene, const Lamp& lamp,
                          const Eigen::Vector3d& direction, const RayHit& hit, int rays,
                          std::uint64_t key, double wavelength_m) {
  const Eigen::Vector3d origin = lamp.world_from_camera.translation();
  const Eigen::Vector3d normal = hit.normal.dot(direction) < 0 ? hit.normal : -hit.normal;
  const Eigen::Vector3d point = origin + hit.range_m * direction + off_surface_m * normal;
  const Eigen::Vector2d shift(share_of(2 * key), share_of(2 * key + 1));
  PixelLight sum;
  for (int i = 0; i < rays; ++i) {
    const Eigen::Vector3d way = around(normal, spread_point(i, rays, shift));
    const auto other = scene.cast(point, way, lamp.max_range_m);
    if (!other) continue;
    const Eigen::Vector3d place = point + other->range_m * way;
    if (!lamp.shines_on(place)) continue;
    const double lit_from_m = (place - origin).norm();
    const Eigen::Vector3d towards = (place - origin) / lit_from_m;
    const auto lit = scene.cast(origin, towards, lamp.max_range_m);
    const bool is_lit = lit && lit->range_m > lit_from_m - 2 * off_surface_m;
    const bool is_seen_from_front = other->normal.dot(way) * other->normal.dot(towards) > 0;
    if (!is_lit || !is_seen_from_front) continue;
    const double cosine = std::abs(other->normal.dot(towards));
    const double strength = amplitude_unit * hit.reflectance * other->reflectance * cosine /
                            (lit_from_m * lit_from_m) / rays;
    const double range_m = (lit_from_m + other->range_m + hit.range_m) / 2;
    sum += light_from(strength, range_m, wavelength_m);
  }
  return sum;
}

}  // namespace tofmap
