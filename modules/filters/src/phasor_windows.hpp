// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "padded_image.hpp"

#include <tofmap/core/image.hpp>

namespace tofmap {

/// A complex number for each pixel.
struct PhasorImage {
  PaddedImage re;
  PaddedImage im;

  PhasorImage(int rows, int cols, int margin) : re(rows, cols, margin), im(re) {}
};

/// The phasors that pixels measure at both frequencies, weighted so that sums of them are optimal
/// estimates of a common phase (docs/filters.md, equation 10). If the phase noise of a pixel is
/// normal with the standard deviation s, its phasor has the mean R = exp(−s²/2) along the true
/// phase and the variance V = (1 − R⁴) / 2 across it. Its weight is R / V, and its Fisher
/// information about the phase is R² / V, which is 1 / s² if noise is small.
struct Phasors {
  PhasorImage a;
  PhasorImage b;
  PaddedImage information;  ///< about the phase of each frequency, 1 / rad²; 0 without a return

  /// No pixel has a return.
  Phasors(int rows, int cols, int margin);

  /// `phase_a` and `phase_b` are in cycles, and `sigma_cycles` is the standard deviation of each of
  /// them. A pixel has no return if one of them is NaN. The margin must be at least the radius of
  /// the windows, pixels.
  Phasors(const ImageF& phase_a, const ImageF& phase_b, const ImageF& sigma_cycles, int margin);
};

/// Fisher information about the phase of a pixel with this phase noise, 1 / rad².
float phase_information(float sigma_cycles);

/// A plane in phase for each pixel: at the offset (x, y) from the pixel, the phase of A is
/// arg(a) + slope · (x, y), and that of B is arg(b) + slope · (x, y) λ_A / λ_B. Variances are those
/// of weighted sums of independent pixels.
struct PhasePlanes {
  PhasorImage a;         ///< unit phasor; 0 if no pixel of the window has a return
  PhasorImage b;         ///< likewise
  PaddedImage slope_x;   ///< to the right, radians of A per pixel
  PaddedImage slope_y;   ///< downwards, radians of A per pixel
  PaddedImage variance;  ///< of the phase of each frequency if the slope is exact, rad²
  /// Variance that errors of the slope add to both phases, since the centroid of the window is not
  /// at the pixel, rad² of A.
  PaddedImage lever_variance;
  PaddedImage slope_variance;  ///< mean of both components, (radians of A per pixel)²
  PaddedImage coherence;       ///< length of the sum phasors over that predicted from the noise

  /// No plane is known: phasors and slopes are 0, the variance is very large.
  PhasePlanes(int rows, int cols, int margin);
};

/// How windows grow.
struct WindowGrowth {
  double wavelength_ratio = 1;  ///< λ_A / λ_B
  double last_radius_px = 12;
  double first_radius_px = 4;
  double growth = 1.4;       ///< largest factor of the radius between two steps
  double max_misfit = 10;    ///< between planes of one surface, squared standard deviations
  double slope_sigma = 0.1;  ///< prior of each component of the slope, radians of A per pixel
};

/// Estimates planes from windows that grow along surfaces but not across edges: the
/// propagation-separation approach of J. Polzehl and V. Spokoiny (Propagation-separation approach
/// for local likelihood estimation, 2006), for the phases of two frequencies (docs/filters.md,
/// equations 11 to 13).
///
/// The radius grows step by step. In each step, every pixel sums the phasors of its window, after
/// rotating them back by the slope of its plane. The weight of a pixel in the window depends on how
/// well its plane of the previous step agrees with that of the window's own pixel, at both
/// frequencies, given the uncertainty of both planes. Wrap counts are not used.
PhasePlanes grow_phase_planes(const Phasors& phasors, int rows, int cols,
                              const WindowGrowth& growth);

}  // namespace tofmap
