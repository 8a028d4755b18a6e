// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "offset_shrinkage.hpp"

#include "significance.hpp"

#include <cmath>

namespace tofmap {
namespace {

/// Halvings of the interval of the variance. They leave 1e-12 of it.
constexpr int halvings = 40;

struct WeightedSpread {
  double mean = 0;
  double squares = 0;  ///< weighted sum of the squared deviations from the mean
};

WeightedSpread spread_with(std::span<const MeasuredOffset> offsets, double variance) {
  double weights = 0;
  double sum = 0;
  for (const MeasuredOffset& one : offsets) {
    weights += 1 / (variance + one.variance);
    sum += one.value / (variance + one.variance);
  }
  WeightedSpread spread{.mean = sum / weights};
  for (const MeasuredOffset& one : offsets) {
    const double deviation = one.value - spread.mean;
    spread.squares += deviation * deviation / (variance + one.variance);
  }
  return spread;
}

/// The plain variance of the values, which that of the true values does not exceed by much.
double plain_variance(std::span<const MeasuredOffset> offsets) {
  double sum = 0;
  double squares = 0;
  for (const MeasuredOffset& one : offsets) {
    sum += one.value;
    squares += one.value * one.value;
  }
  const auto count = static_cast<double>(offsets.size());
  return (squares - sum * sum / count) / (count - 1);
}

}  // namespace

OffsetDistribution distribution_of(std::span<const MeasuredOffset> offsets) {
  if (offsets.size() < 2) return {.mean = offsets.empty() ? 0 : offsets.front().value};
  const double freedom = static_cast<double>(offsets.size()) - 1;
  const WeightedSpread without = spread_with(offsets, 0);
  const double chance = least_significance * std::sqrt(2 * correlated_samples * freedom);
  if (without.squares <= freedom + chance) return {.mean = without.mean};
  double low = 0;
  double high = plain_variance(offsets);
  while (spread_with(offsets, high).squares > freedom) high *= 2;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (spread_with(offsets, middle).squares > freedom ? low : high) = middle;
  }
  return {.mean = spread_with(offsets, high).mean, .variance = high};
}

}  // namespace tofmap
