// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>

namespace tofmap {

/// The variance of one correlation image's values around the fit of all steps, as a function of a
/// pixel's signal s, in squared units of the values:
///
///   v(s) = constant + per_signal s + per_squared_signal s²
///
/// The first term is the noise of readout and rounding, the second one shot noise, whose variance
/// grows with the light, and the third one errors in proportion to the light: correlation
/// functions are no pure sines, and the gains of steps differ slightly.
struct StepNoise {
  double constant = 0;
  double per_signal = 0;
  double per_squared_signal = 0;
  int pixels = 0;  ///< from how many it was estimated; 0: the noise is unknown

  double variance_at(double signal) const {
    return constant + signal * (per_signal + signal * per_squared_signal);
  }
};

/// Probability with which a pixel that follows the model is flagged as inconsistent. About 100
/// pixels of a megapixel image are lost by it.
inline constexpr double inconsistent_by_chance = 1e-4;

/// The x that a χ² variable with so many degrees of freedom exceeds with probability `upper_tail`,
/// which must be in (0, 1).
double chi_square_quantile(int degrees_of_freedom, double upper_tail);

/// Estimates the noise from the residuals of one image, while up to about half of its pixels may be
/// spoiled by motion or saturation.
///
/// Without those, squared_residual / v(s) has a χ² distribution. Pixels are put in bins of equal
/// size by their signal. The median of each bin, divided by the median of that distribution, is an
/// estimate of v at its median signal. Of all curves through two bins that have a constant and
/// one other term, or a single term, the one with the least sum of |log(estimate / v)| is taken.
/// The logarithm counts dark and bright bins alike; the absolute value ignores some wrong bins.
/// This is repeated without the pixels that the estimate makes inconsistent (reweighting; Rousseeuw
/// and Leroy 1987, 'Robust Regression and Outlier Detection').
///
/// `signal`: shot noise grows with it. Pixels where it or the residual is NaN, or `excluded` is
/// not 0, are not used. `least_variance` is that of rounding, 1/12 for whole numbers; v is nowhere
/// smaller. The noise is unknown if fewer than 50 pixels are left.
StepNoise estimate_step_noise(const ImageF& signal, const ImageF& squared_residual,
                              const ImageU8& excluded, int degrees_of_freedom,
                              double least_variance);

/// 1 in pixels whose squared residual exceeds v(signal) times the χ² quantile for
/// inconsistent_by_chance, else 0: their steps do not belong to one phase, since something moved
/// between them or one was saturated. All 0 if the noise is unknown.
ImageU8 inconsistent_pixels(const ImageF& signal, const ImageF& squared_residual,
                            const StepNoise& noise, int degrees_of_freedom);

}  // namespace tofmap
