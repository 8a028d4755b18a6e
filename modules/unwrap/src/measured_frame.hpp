// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/phase_noise.hpp>

namespace tofmap {

/// What every method starts from.
struct MeasuredFrame {
  /// Throws UsageError if images of the frame differ in size. Amplitudes from
  /// `saturation_amplitude` on are saturated; 0: none is.
  MeasuredFrame(const DualFrequencyFrame& frame, double saturation_amplitude);

  DualFrequencyFrame returns;  ///< phases are NaN at both frequencies where either has no return
  ImageU8 valid;               ///< not 0 where both frequencies have one
  ImageU8 saturated;           ///< not 0 where one of them was too strong for that
  PhaseNoise noise;            ///< estimated
  PhaseSigma sigma;            ///< of the noise
};

/// The median of the noise of A's phase over the pixels with a return, cycles; 0 if there are none.
double median_phase_noise_cycles(const MeasuredFrame& frame);

}  // namespace tofmap
