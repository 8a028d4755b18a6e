// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

// The error model of a range, derived in docs/unwrapping.md, 'Errors of a range'. The range that
// frequency f measures in pixel p is
//
//   r_f(p) = r(p) + noise + μ_f(p) + ε_f(p)
//
//   noise   of photons, ambient light and rounding; independent from pixel to pixel:
//             σ_f(p)² = λ_f² [ (c_f m(p) / amplitude_f(p))² + q_f² / 12 ]
//   μ_f     the known systematic error: offset, periodic error, and error with amplitude
//   ε_f     the unknown systematic error, which averaging over pixels does not reduce
//
// `PhaseNoise` and `PhaseSigma` describe the noise. `CameraErrors` in
// tofmap/unwrap/common/frame_errors.hpp describes the differences μ_A − μ_B between two frequencies
// and the standard deviation of ε_A − ε_B.

/// Parameters of the phase noise of one frame at one frequency.
struct PhaseNoise {
  /// c in cycles times the unit of the amplitude: σ = c m / amplitude. Without amplitudes, σ of all
  /// pixels in cycles.
  double scale = 0;
  double quantisation_cycles = 0;  ///< q, the difference between adjacent values of the phase
};

/// Standard deviation of the phase of every pixel, in cycles. NaN where the phase is NaN or the
/// amplitude is not above 0. If `amplitude` is empty, all pixels have amplitude 1. `ambient` is m,
/// the factor by which ambient light raises the noise; if it is empty, m is 1.
ImageF phase_sigma_cycles(const ImageF& phase, const ImageF& amplitude, double scale,
                          double quantisation_cycles = 0, const ImageF& ambient = {});

/// Standard deviation of the phases of a frame at each frequency, as phase_sigma_cycles()
/// computes it.
struct PhaseSigma {
  std::vector<ImageF> cycles;  ///< an image for each frequency

  /// No images.
  PhaseSigma() = default;

  /// `noise` has an element for each frequency; `ambient` may be empty.
  PhaseSigma(const Frame& frame, const std::vector<PhaseNoise>& noise, const ImageF& ambient = {});
};

}  // namespace tofmap
