// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {

struct SimulatorOptions;

/// By how much a camera's ranges at one frequency are wrong however often they are measured
/// (docs/simulator.md, equations 9 to 12). By default not at all.
struct RangeErrors {
  double wavelength_m = 1;
  PhaseError of_phase;            ///< offset and harmonics, of the true phase
  double dark_end_m = 0;          ///< at the dark end of the amplitudes; at the bright end 0
  double pattern_sigma_m = 0;     ///< of the offsets of pixels
  std::uint64_t pattern_key = 0;  ///< draws them

  bool are_none() const;

  /// Of a pixel that would measure this signal without errors and noise. The same signal and pixel
  /// have the same error in every frame.
  double at_m(const std::complex<double>& signal, std::size_t pixel) const;

  /// Of length one: what the signal is multiplied by.
  std::complex<double> rotation(const std::complex<double>& signal, std::size_t pixel) const;
};

/// Errors of image A and image B of one camera; `errors_seed` draws what the options leave open.
RangeErrors range_errors_a(const SimulatorOptions& options, const Modulation& modulation);
RangeErrors range_errors_b(const SimulatorOptions& options, const Modulation& modulation);

/// The part of the image that ambient light falls on, and by what factor it raises the noise there.
struct AmbientLight {
  double factor = 1;
  double first_col = 0, end_col = 0;  ///< pixels whose centres lie in [first, end) are lit
  double first_row = 0, end_row = 0;

  /// 1 where no ambient light falls.
  double noise_factor(Eigen::Index row, Eigen::Index col) const;
};

AmbientLight ambient_light(const SimulatorOptions& options, const CameraModel& camera);

/// The nearest of 2^bits phases, [0, 1); with 0 bits the phase itself.
float quantised(float phase_cycles, int bits);

/// Throws UsageError that names the option if values are allowed one by one, but not together.
void check_systematic_errors(const SimulatorOptions& options);

}  // namespace tofmap
