// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene_at_time.hpp"

#include <array>
#include <complex>
#include <cstdint>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

struct SimulatorOptions;

/// Light that reaches a pixel. The arguments of the complex numbers are phases.
struct PixelLight {
  std::complex<double> first = 0;  ///< signal at the modulation frequency
  std::complex<double> third = 0;  ///< signal at three times that frequency, of the same strength
  double level = 0;                ///< sum of the strengths, without phase

  PixelLight& operator+=(const PixelLight& other) {
    first += other.first;
    third += other.third;
    level += other.level;
    return *this;
  }

  PixelLight operator/(double count) const { return {first / count, third / count, level / count}; }
};

/// Light of this strength (its amplitude) whose path, out and back, is twice `range_m` long.
PixelLight light_from(double strength, double range_m, double wavelength_m);

/// How a sensor converts light to charge (docs/simulator.md, equations 5 to 8). The defaults are an
/// ideal sensor.
struct SensorEffects {
  double harmonic = 0;    ///< third harmonic of the correlation function, relative to the first
  double dark_level = 0;  ///< charge of each sample without light, in units of the amplitude
  double full_well = 0;   ///< largest charge of a sample, in units of the amplitude; 0: no limit

  /// Whether the sensor is ideal, so that demodulate() returns PixelLight::first of four equal
  /// samples.
  bool are_none() const { return harmonic == 0 && dark_level == 0 && full_well == 0; }
};

SensorEffects sensor_effects(const SimulatorOptions& options, const Modulation& modulation);

/// The complex signal from four samples that are a quarter of a period apart (docs/simulator.md,
/// equation 6). `samples` is the light at each of them.
std::complex<double> demodulate(const std::array<PixelLight, 4>& samples,
                                const SensorEffects& effects);

/// Standard deviation of the noise that dark charge adds to each component of the signal.
double dark_noise_sigma(const SensorEffects& effects);

/// The camera as a light source: it illuminates what is in its image.
struct Lamp {
  const CameraModel& camera;
  Pose world_from_camera;
  double max_range_m = 0;  ///< rays end here

  /// Whether a point, in the world frame, is in the image of the camera. Ignores occlusion.
  bool shines_on(const Eigen::Vector3d& point_m) const;
};

/// Multipath light: light that the lamp sends to another surface, from there to the point that the
/// pixel sees along `direction`, and from there to the pixel. It is the mean over `rays` directions
/// in the hemisphere over that point, with a cosine-weighted distribution (docs/simulator.md,
/// equation 7). `hit` is the point; `key` shifts the pattern of directions.
PixelLight indirect_light(const SceneAtTime& scene, const Lamp& lamp,
                          const Eigen::Vector3d& direction, const RayHit& hit, int rays,
                          std::uint64_t key, double wavelength_m);

}  // namespace tofmap
