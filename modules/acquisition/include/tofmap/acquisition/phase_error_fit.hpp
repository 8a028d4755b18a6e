// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/acquisition/camera_calibration.hpp>

namespace tofmap {

/// What both frequencies measure at one pixel, and how far it is, known or found by unwrapping.
struct RangePair {
  float a_m = 0;  ///< with the wraps that come nearest to the reference
  float b_m = 0;
  float reference_m = 0;
};

/// Appends the pixels `first`, `first` + `stride`, … of a frame, row by row, that have a return at
/// both frequencies and a reference range.
void append_range_pairs(const DualFrequencyFrame& frame, const Modulation& modulation,
                        const ImageF& reference_m, int first, int stride,
                        std::vector<RangePair>& pairs);

/// A value and the standard deviation of its error.
struct Estimate {
  double value = 0;
  double sigma = 0;
};

/// What both frequencies measure too far.
struct PhaseErrorFit {
  PhaseError error_a;
  PhaseError error_b;
  Estimate offset_m;          ///< of A less that of B
  double residual_rms_m = 0;  ///< of what was fitted, with the errors taken out
};

struct PhaseErrorFitOptions {
  std::vector<int> orders;    ///< of the harmonics
  double max_error_m = 0.15;  ///< what is farther off, from the median of all, counts as wrong
};

/// Finds offsets and harmonics of both frequencies from references that are known ranges. Harmonics
/// below four standard deviations are left out. Throws InputError if the pairs do not tell all
/// unknowns: there are too few, or their phases do not cover the cycle.
PhaseErrorFit fit_to_references(std::span<const RangePair> pairs, const Modulation& modulation,
                                const PhaseErrorFitOptions& options);

/// Finds harmonics from how both frequencies disagree; references tell wraps alone. Both are taken
/// to have the same harmonics in cycles, as electronics that drive both have. Offsets stay zero:
/// what both share cannot be seen, and `offset_m` has motion between both images in it, too.
/// Otherwise as above.
PhaseErrorFit fit_to_beat(std::span<const RangePair> pairs, const Modulation& modulation,
                          const PhaseErrorFitOptions& options);

}  // namespace tofmap
