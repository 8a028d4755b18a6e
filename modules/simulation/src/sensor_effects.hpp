// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <complex>
#include <cstdint>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

struct SimulatorOptions;

/// Light that reaches a pixel, as complex numbers of its strength and phase.
struct PixelLight {
  std::complex<double> first = 0;  ///< at the modulation frequency
  std::complex<double> third = 0;  ///< at three times that, of as much strength
  double level = 0;                ///< in all

  PixelLight& operator+=(const PixelLight& other) {
    first += other.first;
    third += other.third;
    level += other.level;
    return *this;
  }

  PixelLight operator/(double count) const { return {first / count, third / count, level / count}; }
};

/// Light of so much strength that has come this far, there and back over two.
PixelLight light_from(double strength, double range_m, double wavelength_m);

/// What a sensor makes of light (docs/simulator.md, equations 5 to 8). By default an ideal one.
struct SensorEffects {
  double harmonic = 0;    ///< third harmonic of the correlation function, as a share of the first
  double dark_level = 0;  ///< charge of each sample without light, in units of the amplitude
  double full_well = 0;   ///< charge that a sample can hold; 0: any

  /// Whether four samples say the same as the light itself.
  bool are_none() const { return harmonic == 0 && dark_level == 0 && full_well == 0; }
};

SensorEffects sensor_effects(const SimulatorOptions& options, const Modulation& modulation);

/// The complex signal that four samples a quarter of a period apart give, each of the light of its
/// moment.
std::complex<double> demodulate(const std::array<PixelLight, 4>& samples,
                                const SensorEffects& effects);

/// The standard deviation that dark charge adds to either component of the signal.
double dark_noise_sigma(const SensorEffects& effects);

/// A camera that lights what it sees.
struct Lamp {
  const CameraModel& camera;
  Pose world_from_camera;
  double max_range_m = 0;

  /// Whether its light falls that way, if nothing is in between.
  bool shines_on(const Eigen::Vector3d& point_m) const;
};

/// Light that comes to a pixel by way of one other surface: the mean over `rays` directions, spread
/// by the cosine over the hemisphere above the point that the pixel sees along `direction`, of the
/// light that the surfaces there have of the lamp. `key` turns the directions.
PixelLight indirect_light(const RayScene& scene, const Lamp& lamp, const Eigen::Vector3d& direction,
                          const RayHit& hit, int rays, std::uint64_t key, double wavelength_m);

}  // namespace tofmap
