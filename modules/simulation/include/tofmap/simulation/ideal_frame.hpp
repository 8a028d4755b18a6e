// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

struct SimulatorOptions;

/// A complex signal for each pixel: the amplitude is its modulus, the phase its argument.
using ImageC = Image<std::complex<double>>;

/// The complex signals that the simulated camera would measure without range errors, noise and
/// quantisation (docs/simulator.md, equation 6). NaN where no ray of the pixel meets a surface.
/// Weak signals are kept, even those that a sensor would lose.
struct IdealFrame {
  int index = 0;
  double timestamp_s = 0;       ///< of the first image
  std::vector<ImageC> signals;  ///< an image for each frequency
  Pose world_from_camera;       ///< when the first image is taken
  ImageF range_truth_m;         ///< along the ray of the pixel's centre; NaN if it meets no surface
};

/// The frame that the sensor measures from ideal signals. It uses the options that do not need the
/// scene: systematic errors, ambient light, noise (`range_noise_m` and `dark_level`) and
/// `phase_bits` (docs/simulator.md, equations 2 to 4 and 8 to 14). `seed` determines the noise, and
/// `errors_seed` the systematic errors.
///
/// Since ray casting takes far longer than this function, one ideal frame can be measured with many
/// different errors. With the options of the simulator that made `ideal`, the result is identical
/// to Simulator::simulate(ideal.index), bit by bit. Image size and frequencies must be those of
/// that simulator. Throws UsageError if the images have another size than the camera of `sensor`,
/// or if options contradict each other.
Frame measured_frame(const IdealFrame& ideal, const SensorModel& sensor,
                     const SimulatorOptions& options);

}  // namespace tofmap
