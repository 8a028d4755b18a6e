// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pixel_signal.hpp"
#include "systematic_errors.hpp"

#include <complex>
#include <cstdint>
#include <optional>

#include <tofmap/core/frame.hpp>

namespace tofmap {

enum class ImageOfFrame : std::uint8_t { a = 0, b = 1 };

/// The key of the noise of one image; `seed`, frame and image draw it.
std::uint64_t noise_key(const SimulatorOptions& options, int frame, ImageOfFrame image);

/// What a sensor makes of the ideal signals of one image: errors of ranges, ambient light, noise
/// and quantisation (docs/simulator.md, equations 2 to 4 and 8 to 14).
struct SensorReadout {
  double wavelength_m = 1;
  RangeErrors errors;
  AmbientLight ambient;
  double noise_sigma = 0;  ///< of either component of the signal, without ambient light
  std::uint64_t noise_key = 0;
  int phase_bits = 0;
  Eigen::Index cols = 0;

  struct Pixel {
    PhaseAndAmplitude measured;
    std::complex<double> signal_without_errors;  ///< of the range; the noise is the same
    double range_sigma_m = 0;                    ///< what noise makes of the range
  };

  /// Nothing where the amplitude rounds to zero.
  std::optional<Pixel> read(const std::complex<double>& ideal, Eigen::Index row,
                            Eigen::Index col) const;
};

SensorReadout sensor_readout(const SimulatorOptions& options, const SensorModel& sensor, int frame,
                             ImageOfFrame image);

}  // namespace tofmap
