// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "padded_image.hpp"

#include <cstddef>
#include <vector>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// A complex number for each pixel.
struct PhasorImage {
  PaddedImage re;
  PaddedImage im;

  PhasorImage(int rows, int cols, int margin) : re(rows, cols, margin), im(re) {}
};

/// The phasors that pixels measure at each frequency, weighted so that sums of them are optimal
/// estimates of a common phase (docs/filters.md, equation 10). If the phase noise of a pixel is
/// normal with the standard deviation s, its phasor has the mean R = exp(−s²/2) along the true
/// phase and the variance V = (1 − R⁴) / 2 across it. Its weight is R / V, and its Fisher
/// information about the phase is R² / V, which is 1 / s² if noise is small.
struct Phasors {
  std::vector<PhasorImage> frequencies;
  PaddedImage information;  ///< about the phase of each frequency, 1 / rad²; 0 without a return

  /// `phases` has the image of each frequency, in cycles, at least one, and `sigma_cycles` is the
  /// standard deviation of each of them. A pixel has no return if one of its phases is NaN. The
  /// margin must be at least the radius of the windows, pixels.
  Phasors(const std::vector<ImageF>& phases, const ImageF& sigma_cycles, int margin);
};

/// Fisher information about the phase of a pixel with this phase noise, 1 / rad².
float phase_information(float sigma_cycles);

/// A plane in phase for each pixel: at the offset (x, y) from the pixel, the phase of frequency f
/// is arg(phases[f]) + slope · (x, y) λ_A / λ_f. Variances are those of weighted sums of
/// independent pixels.
struct PhasePlanes {
  std::vector<PhasorImage> phases;  ///< unit phasors; 0 if no pixel of the window has a return
  PaddedImage slope_x;              ///< to the right, radians of A per pixel
  PaddedImage slope_y;              ///< downwards, radians of A per pixel
  PaddedImage variance;             ///< of the phase of each frequency if the slope is exact, rad²
  /// Variance that errors of the slope add to the phases, since the centroid of the window is not
  /// at the pixel, rad² of A.
  PaddedImage lever_variance;
  PaddedImage slope_variance;  ///< mean of both components, (radians of A per pixel)²
  PaddedImage coherence;       ///< length of the sum phasors over that predicted from the noise

  /// No plane is known: phasors and slopes are 0, the variance is very large.
  PhasePlanes(std::size_t frequencies, int rows, int cols, int margin);
};

/// How windows grow.
struct WindowGrowth {
  std::vector<float> wavelength_ratios;  ///< λ_A / λ_f of each frequency f; the first is 1
  double last_radius_px = 12;
  double first_radius_px = 4;
  double growth = 1.4;  ///< largest factor of the radius between two steps
  /// Between planes of one surface, squared standard deviations for each frequency.
  double max_misfit = 5;
  double slope_sigma = 0.1;  ///< prior of each component of the slope, radians of A per pixel
};

/// Estimates planes from windows that grow along surfaces but not across edges: the
/// propagation-separation approach of J. Polzehl and V. Spokoiny (Propagation-separation approach
/// for local likelihood estimation, 2006), for the phases of all frequencies (docs/filters.md,
/// equations 11 to 13).
///
/// The radius grows step by step. In each step, every pixel sums the phasors of its window, after
/// rotating them back by the slope of its plane. The weight of a pixel in the window depends on how
/// well its plane of the previous step agrees with that of the window's own pixel, at all
/// frequencies, given the uncertainty of both planes. Wrap counts are not used.
PhasePlanes grow_phase_planes(const Phasors& phasors, int rows, int cols,
                              const WindowGrowth& growth);

}  // namespace tofmap
