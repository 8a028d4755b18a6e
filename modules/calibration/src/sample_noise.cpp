// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_noise.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Smallest standard deviation of a value, from the quantisation of phase images and lens errors.
constexpr double least_floor_m = 1e-3;

/// Smallest ratio of the noise of the noisiest quarter of the values to that of the least noisy
/// quarter. Below it, the spreads of the two differ too little to separate noise from the rest.
constexpr double telling_ratio = 1.5;

/// Noise and spread of a set of values.
struct Spread {
  double noise_squared = 0;  ///< square of the median relative noise
  double variance = 0;       ///< robust variance in m², from the median absolute deviation
};

Spread spread_of(std::span<const NoisyValue> values) {
  std::vector<float> noises;
  std::vector<float> numbers;
  for (const NoisyValue& one : values) {
    noises.push_back(one.relative_noise);
    numbers.push_back(one.value_m);
  }
  const float middle = median(numbers);
  for (float& number : numbers) number = std::abs(number - middle);
  const double sigma = sigma_of_median_deviation * double{median(numbers)};
  const double noise{median(noises)};
  return {noise * noise, sigma * sigma};
}

}  // namespace

SampleNoise estimate_noise(std::vector<NoisyValue> values) {
  std::ranges::sort(values, {}, &NoisyValue::relative_noise);
  const std::size_t quarter = std::max<std::size_t>(1, values.size() / 4);
  const Spread bright = spread_of(std::span(values).first(quarter));
  const Spread dark = spread_of(std::span(values).last(quarter));
  if (dark.noise_squared < telling_ratio * telling_ratio * bright.noise_squared) {
    const Spread all = spread_of(values);
    return {std::sqrt(all.variance / all.noise_squared), least_floor_m};
  }
  const double unit_squared = std::max(
      0.0, (dark.variance - bright.variance) / (dark.noise_squared - bright.noise_squared));
  const double floor_squared = std::max(0.0, bright.variance - unit_squared * bright.noise_squared);
  return {std::sqrt(unit_squared), std::max(least_floor_m, std::sqrt(floor_squared))};
}

}  // namespace tofmap
