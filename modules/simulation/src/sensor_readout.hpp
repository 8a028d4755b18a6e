// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pixel_signal.hpp"
#include "systematic_errors.hpp"

#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// The key of the noise of the image at one frequency, of `frequencies`. It depends on `seed`,
/// frame index and frequency.
std::uint64_t noise_key(const SimulatorOptions& options, int frame, std::size_t frequency,
                        std::size_t frequencies);

/// How a sensor measures the ideal signals of one image: with range errors, ambient light, noise
/// and quantisation (docs/simulator.md, equations 2 to 4 and 8 to 14).
struct SensorReadout {
  double wavelength_m = 1;
  double contrast = 1;  ///< factor of the signal at this frequency
  RangeErrors errors;
  AmbientLight ambient;
  double noise_sigma = 0;  ///< of each component of the signal, without ambient light
  std::uint64_t noise_key = 0;
  int phase_bits = 0;     ///< 0: phases are not quantised
  Eigen::Index cols = 0;  ///< width of the image

  struct Pixel {
    PhaseAndAmplitude measured;
    std::complex<double> signal_without_errors;  ///< with noise, but without range errors
    double range_sigma_m = 0;                    ///< standard deviation of the range noise
  };

  /// Measures the signal of one pixel. Empty if the amplitude rounds to zero.
  std::optional<Pixel> read(const std::complex<double>& ideal, Eigen::Index row,
                            Eigen::Index col) const;
};

SensorReadout sensor_readout(const SimulatorOptions& options, const SensorModel& sensor, int frame,
                             std::size_t frequency);

}  // namespace tofmap
