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

/// The systematic errors of the ranges of one frequency, measured minus true (docs/simulator.md,
/// equations 9 to 12). The defaults are no errors.
struct RangeErrors {
  double wavelength_m = 1;
  PhaseError of_phase;            ///< offset and harmonics, as a function of the true phase
  double dark_end_m = 0;          ///< error at the dark end of the amplitudes; 0 at the bright end
  double pattern_sigma_m = 0;     ///< standard deviation of the offsets of individual pixels
  std::uint64_t pattern_key = 0;  ///< seed of these offsets

  bool are_none() const;

  /// The range error of a pixel whose signal without errors and noise is `signal`. The same signal
  /// and pixel have the same error in every frame.
  double at_m(const std::complex<double>& signal, std::size_t pixel) const;

  /// The unit complex number by which the signal must be multiplied to get this error.
  std::complex<double> rotation(const std::complex<double>& signal, std::size_t pixel) const;
};

/// The errors of a camera at one frequency. `errors_seed` determines what the options leave open.
RangeErrors range_errors(const SimulatorOptions& options, const Modulation& modulation,
                         std::size_t frequency);

/// A rectangle of the image in which ambient light increases the noise.
struct AmbientLight {
  double factor = 1;                  ///< of the noise
  double first_col = 0, end_col = 0;  ///< pixels whose centres lie in [first, end) are lit
  double first_row = 0, end_row = 0;  ///< pixels whose centres lie in [first, end) are lit

  /// The factor of the noise at a pixel: 1 outside the rectangle.
  double noise_factor(Eigen::Index row, Eigen::Index col) const;
};

AmbientLight ambient_light(const SimulatorOptions& options, const CameraModel& camera);

/// The phase rounded to the nearest of 2^bits levels, in [0, 1). Not rounded if `bits` is 0.
float quantised(float phase_cycles, int bits);

/// Throws UsageError, which names the option, if the number of phase bits is not allowed, or if the
/// rectangle of ambient light is empty.
void check_systematic_errors(const SimulatorOptions& options);

}  // namespace tofmap
