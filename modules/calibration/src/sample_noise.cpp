// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_noise.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Steps of phase images and lens errors: no value is better.
constexpr double least_floor_m = 1e-3;

/// Of the noise of the noisier quarter over that of the other: below, both spread alike.
constexpr double telling_ratio = 1.5;

struct Spread {
  double noise_squared = 0;  ///< relative; median
  double variance = 0;       ///< robust, m²
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
