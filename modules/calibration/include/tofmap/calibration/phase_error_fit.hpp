// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/acquisition/camera_calibration.hpp>

namespace tofmap {

/// The ranges that two frequencies, A and B, measure at one pixel, and a reference range, which is
/// either known or the result of unwrapping. All ranges are radial.
struct RangeSample {
  float a_m = 0;  ///< range of A, with the wrap count that brings it nearest to the reference
  float b_m = 0;  ///< range of B, with the wrap count that brings it nearest to the reference
  float reference_m = 0;  ///< true range, or the range found by unwrapping
  /// Standard deviation of the noise of a_m in an unknown unit, which noise_b shares: λ /
  /// amplitude, or 1 without amplitudes.
  float noise_a = 1;
  float noise_b = 1;  ///< standard deviation of the noise of b_m, like noise_a
};

/// Appends samples of the pixels `first`, `first` + `stride`, … of a frame, counted row by row.
/// Leaves out pixels without a return at one of the frequencies, saturated pixels, and pixels
/// without a reference range (NaN). A is the first frequency of the frame, `b` is that of B,
/// counted from 0; it may be that of A, of cameras with one frequency. Throws UsageError if
/// `reference_m` has another size than the frame, `first` is negative or `stride` is less than 1.
void append_range_samples(const Frame& frame, const SensorModel& sensor, const ImageF& reference_m,
                          std::size_t b, int first, int stride, std::vector<RangeSample>& samples);

/// How well the phases of A agree with the reference ranges apart from a common offset, 0 … 1: the
/// length of the mean of exp(i ψ), where ψ is the difference of the phases in radians. It is 0 if
/// they are unrelated, and 0.6 if their difference has a standard deviation of a sixth of a
/// wavelength. NaN without samples.
double agreement_with_references(std::span<const RangeSample> samples,
                                 const Modulation& modulation);

/// An estimated value and the standard deviation of its error.
struct Estimate {
  double value = 0;
  double sigma = 0;
};

/// The systematic errors of both frequencies, measured minus true, that a fit found.
struct PhaseErrorFit {
  PhaseError error_a;
  PhaseError error_b;
  double offset_sigma_a_m = 0;  ///< standard deviation of error_a.offset_m; 0 if it was not fitted
  double offset_sigma_b_m = 0;  ///< standard deviation of error_b.offset_m; 0 if it was not fitted
  Estimate offset_m;            ///< offset of A minus offset of B
  double residual_rms_m = 0;    ///< weighted RMS of the fitted values after subtracting the errors
};

/// Options of the fits.
struct PhaseErrorFitOptions {
  std::vector<int> orders;  ///< orders of the harmonics, in periods per wavelength
  /// Samples whose fitted value differs from the median of all samples by more than this, and by
  /// more than three standard deviations of their noise, are left out. Metres.
  double max_error_m = 0.15;
};

/// Fits offsets and harmonics of both frequencies to known reference ranges by least squares.
/// Weights samples by their inverse variance, which is estimated from the spread of the samples.
/// Leaves out harmonics below four standard deviations. Throws InputError if the samples do not
/// determine all unknowns: there are too few of them, or their phases do not cover the cycle.
PhaseErrorFit fit_to_references(std::span<const RangeSample> samples, const Modulation& modulation,
                                const PhaseErrorFitOptions& options);

/// Fits harmonics to the differences of the ranges of both frequencies (docs/calibration.md,
/// equation 2). The reference ranges only determine wrap counts, so they need not be exact.
///
/// Assumes that both frequencies have the same harmonics in cycles, because the same electronics
/// modulates both. The offsets in `error_a` and `error_b` stay 0: an offset that both frequencies
/// share cannot be observed, and `offset_m` also contains the motion between the two images. Leaves
/// out harmonics below 2 mm, which motion alone can cause. Weights, the limit of four standard
/// deviations and failures are as in fit_to_references().
PhaseErrorFit fit_to_residual(std::span<const RangeSample> samples, const Modulation& modulation,
                              const PhaseErrorFitOptions& options);

}  // namespace tofmap
