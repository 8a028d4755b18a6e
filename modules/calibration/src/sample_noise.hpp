// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tofmap {

/// A value with the standard deviation of its noise, in an unknown unit.
struct NoisyValue {
  float relative_noise = 1;
  float value_m = 0;
};

/// The standard deviations of values about their mean: noise, and what is the same for all (errors
/// that are to be found, edges, motion).
struct SampleNoise {
  double unit_m = 0;   ///< of the relative noise
  double floor_m = 0;  ///< what is the same for all

  double noise_m(double relative) const { return unit_m * relative; }

  /// The inverse variance.
  double weight(double relative) const {
    const double noise = noise_m(relative);
    return 1 / (floor_m * floor_m + noise * noise);
  }
};

/// By how much farther noisy values spread than less noisy ones; if all are about as noisy, all of
/// their spread is taken for noise. There must be one at least.
SampleNoise estimate_noise(std::vector<NoisyValue> values);

}  // namespace tofmap
