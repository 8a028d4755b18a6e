// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tofmap {

/// A sequence of random numbers that the seed determines. Sequences of other purposes are
/// independent.
class RandomDraw {
 public:
  RandomDraw(int seed, std::uint64_t purpose)
      : key_(mix(static_cast<std::uint64_t>(seed) + purpose)) {}

  double between(double low, double high) {
    constexpr double unit = 0x1p-53;
    return low + (high - low) * static_cast<double>(mix(key_ ^ mix(counter_++)) >> 11U) * unit;
  }

  /// A number whose logarithm is distributed uniformly.
  double log_between(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }

  int index(int count) { return std::min(static_cast<int>(between(0, count)), count - 1); }

  /// The numbers 0 … count − 1 in random order.
  std::vector<int> order(int count) {
    std::vector<int> numbers;
    for (int i = 0; i < count; ++i) numbers.push_back(i);
    for (int i = count - 1; i > 0; --i) {
      std::swap(numbers[static_cast<std::size_t>(i)],
                numbers[static_cast<std::size_t>(index(i + 1))]);
    }
    return numbers;
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace tofmap
