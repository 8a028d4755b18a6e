// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

struct SimulatorOptions;

using ImageC = Image<std::complex<double>>;

/// What the simulated camera would measure without errors of ranges, noise, loss of weak signals,
/// and quantisation: the complex signal of each pixel (docs/simulator.md, equation 6), NaN where no
/// ray meets a surface. A weak signal is kept, however weak it is.
struct IdealFrame {
  int index = 0;
  double timestamp_s = 0;
  ImageC signal_a;
  ImageC signal_b;
  Pose world_from_camera;  ///< when A was taken
  ImageF range_truth_m;    ///< along the ray of the pixel's centre; NaN where nothing is hit
};

/// The frame that the sensor makes of ideal signals, by those options that do not need the scene:
/// systematic errors, ambient light, noise of `range_noise_m` and `dark_level`, and `phase_bits`
/// (docs/simulator.md, equations 2 to 4 and 8 to 14). `seed` and `errors_seed` draw noise and
/// errors.
///
/// Casting rays takes far longer than this, so that one ideal frame can be measured with many
/// errors. With the options of the simulator that made `ideal`, the result has the same bits as
/// Simulator::simulate(ideal.index). The image size and the frequencies must be that simulator's;
/// throws UsageError if the images have another size than `sensor`, or options do not fit together.
DualFrequencyFrame measured_frame(const IdealFrame& ideal, const SensorModel& sensor,
                                  const SimulatorOptions& options);

}  // namespace tofmap
