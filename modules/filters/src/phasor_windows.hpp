// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "padded_image.hpp"

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Complex numbers of all pixels.
struct PhasorImage {
  PaddedImage re;
  PaddedImage im;

  PhasorImage(int rows, int cols, int margin) : re(rows, cols, margin), im(re) {}
};

/// What pixels measure at both frequencies, weighted so that sums of phasors are the best estimates
/// of a common phase. A pixel whose phase is normal with the standard deviation s, wrapped, has the
/// mean phasor R = exp(−s²/2) along the true phase and the variance V = (1 − R⁴) / 2 across it; it
/// weighs R / V and holds the information R² / V on the phase, which is 1 / s² where noise is
/// small.
struct Phasors {
  PhasorImage a;
  PhasorImage b;
  PaddedImage information;  ///< on the phase at either frequency, 1 / rad²; 0 without a return

  Phasors(int rows, int cols, int margin);

  /// Phases and the standard deviation of either, cycles; NaN where there is no return. The margin
  /// is at least that of the windows that are to be summed.
  Phasors(const ImageF& phase_a, const ImageF& phase_b, const ImageF& sigma_cycles, int margin);
};

/// Information on a phase, 1 / rad², of a pixel with this noise.
float phase_information(float sigma_cycles);

/// Planes in phase, one a pixel: at the offset (x, y) from its pixel the phase is
/// arg(a) + slope · (x, y) at A, and arg(b) + slope · (x, y) λ_A / λ_B at B. Variances are those of
/// weighted sums of independent pixels.
struct PhasePlanes {
  PhasorImage a;  ///< of length 1; 0 without a return in the window
  PhasorImage b;
  PaddedImage slope_x;         ///< radians of A a pixel
  PaddedImage slope_y;         ///< downwards
  PaddedImage variance;        ///< of either phase by itself, rad²
  PaddedImage lever_variance;  ///< what the slopes add to both phases at a window's edge, rad² of A
  PaddedImage slope_variance;  ///< of a component
  PaddedImage coherence;       ///< length of the sums over what the noise of the pixels predicts

  PhasePlanes(int rows, int cols, int margin);
};

/// How windows grow.
struct WindowGrowth {
  double wavelength_ratio = 1;  ///< λ_A / λ_B
  double last_radius_px = 12;
  double first_radius_px = 4;
  double growth = 1.4;       ///< of the radius from a step to the next, at most
  double max_misfit = 10;    ///< between planes that are one surface: squared standard deviations
  double slope_sigma = 0.1;  ///< of surfaces, a component: radians of A a pixel
};

/// Planes from windows that grow along surfaces and not across edges: the propagation–separation
/// of J. Polzehl and V. Spokoiny (Propagation-separation approach for local likelihood estimation,
/// 2006) for phases of two frequencies.
///
/// Step by step the radius grows. In each step a pixel sums the phasors of its window, turned back
/// by the slope that it knows, and a pixel of the window takes part as far as its plane of the step
/// before agrees with the own one, at both frequencies, within the uncertainty of both. Wraps do
/// not matter to that.
PhasePlanes grow_phase_planes(const Phasors& phasors, int rows, int cols,
                              const WindowGrowth& growth);

}  // namespace tofmap
