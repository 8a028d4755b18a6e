// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tofmap {

/// A value and its noise.
struct NoisyValue {
  float relative_noise = 1;  ///< standard deviation of the noise, in an unknown unit
  float value_m = 0;
};

/// A model of the spread of values: noise, and a floor that is the same for all values (systematic
/// errors, edges, motion).
struct SampleNoise {
  double unit_m = 0;   ///< metres per unit of NoisyValue::relative_noise
  double floor_m = 0;  ///< standard deviation that all values share

  /// Standard deviation of the noise of a value with this relative noise.
  double noise_m(double relative) const { return unit_m * relative; }

  /// Inverse of the total variance of a value with this relative noise.
  double weight(double relative) const {
    const double noise = noise_m(relative);
    return 1 / (floor_m * floor_m + noise * noise);
  }
};

/// Estimates the unit of the noise and the floor by comparing the spread of the noisiest quarter of
/// the values with that of the least noisy quarter. If all values are about equally noisy,
/// attributes all of the spread to noise. `values` must not be empty.
SampleNoise estimate_noise(std::vector<NoisyValue> values);

}  // namespace tofmap
