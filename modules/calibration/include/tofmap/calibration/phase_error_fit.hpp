// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/acquisition/camera_calibration.hpp>

namespace tofmap {

/// What both frequencies measure at one pixel, and how far it is, known or found by unwrapping.
struct RangeSample {
  float a_m = 0;  ///< with the wraps that come nearest to the reference
  float b_m = 0;
  float reference_m = 0;
  /// Standard deviations of the noise of a_m and b_m, both in one unknown unit: λ / amplitude, or 1
  /// without amplitudes.
  float noise_a = 1;
  float noise_b = 1;
};

/// Appends the pixels `first`, `first` + `stride`, … of a frame, row by row, that have a return at
/// both frequencies, not saturated, and a reference range.
void append_range_samples(const DualFrequencyFrame& frame, const SensorModel& sensor,
                          const ImageF& reference_m, int first, int stride,
                          std::vector<RangeSample>& samples);

/// A value and the standard deviation of its error.
struct Estimate {
  double value = 0;
  double sigma = 0;
};

/// What both frequencies measure too far.
struct PhaseErrorFit {
  PhaseError error_a;
  PhaseError error_b;
  double offset_sigma_a_m = 0;  ///< 0 if offsets were not looked for
  double offset_sigma_b_m = 0;
  Estimate offset_m;          ///< of A less that of B
  double residual_rms_m = 0;  ///< of what was fitted, with the errors taken out
};

struct PhaseErrorFitOptions {
  std::vector<int> orders;  ///< of the harmonics
  /// What is farther off, from the median of all, counts as wrong, unless its noise explains it.
  double max_error_m = 0.15;
};

/// Finds offsets and harmonics of both frequencies from references that are known ranges. Samples
/// count by the inverse of their variance, which is found from how they spread. Harmonics
/// below four standard deviations are left out. Throws InputError if the samples do not tell all
/// unknowns: there are too few, or their phases do not cover the cycle.
PhaseErrorFit fit_to_references(std::span<const RangeSample> samples, const Modulation& modulation,
                                const PhaseErrorFitOptions& options);

/// Finds harmonics from how both frequencies disagree; references tell wraps alone. Both are taken
/// to have the same harmonics in cycles, as electronics that drive both have. Offsets stay zero:
/// what both share cannot be seen, and `offset_m` has motion between both images in it, too.
/// Harmonics below 2 mm are left out, which motion may feign. Otherwise as above.
PhaseErrorFit fit_to_residual(std::span<const RangeSample> samples, const Modulation& modulation,
                              const PhaseErrorFitOptions& options);

}  // namespace tofmap
