// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

// The error model of a range (docs/unwrapping.md, 'Errors of a range', has its derivation). The
// range that frequency f measures in pixel p is
//
//   r_f(p) = r(p) + noise + μ_f(p) + ε_f(p)
//
//   noise   of photons, of ambient light, and of rounding; independent from pixel to pixel:
//             σ_f(p)² = λ_f² [ (c_f m(p) / amplitude_f(p))² + q_f² / 12 ]
//   μ_f     offset, periodic error, and error with amplitude, as far as they are known
//   ε_f     what of the systematic errors is not known. Averaging over pixels does not lower it.
//
// `PhaseNoise`, `PhaseSigma`: the noise. `CameraErrors` in tofmap/unwrap/common/frame_errors.hpp:
// what is known of μ_A − μ_B, and the standard deviation of ε_A − ε_B.

/// The noise of the phases of one frame.
struct PhaseNoise {
  double scale_a = 0;  ///< c_A, cycles times the unit of the amplitude: σ = c m / amplitude.
                       ///< Without amplitudes it is σ itself, for all pixels
  double scale_b = 0;
  double quantisation_a_cycles = 0;  ///< q_A, the step from a phase to the next larger one
  double quantisation_b_cycles = 0;
};

/// σ of the phase in every pixel, cycles; NaN where the phase is NaN or the amplitude is 0.
/// `amplitude` may be empty. `ambient` is m, by which ambient light raises the noise; if it is
/// empty, m is 1.
ImageF phase_sigma_cycles(const ImageF& phase, const ImageF& amplitude, double scale,
                          double quantisation_cycles = 0, const ImageF& ambient = {});

/// The same at both frequencies.
struct PhaseSigma {
  ImageF a_cycles;
  ImageF b_cycles;

  PhaseSigma() = default;
  PhaseSigma(const DualFrequencyFrame& frame, const PhaseNoise& noise, const ImageF& ambient = {});
};

}  // namespace tofmap
