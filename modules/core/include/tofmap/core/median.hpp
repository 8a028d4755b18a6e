// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tofmap {

/// The median of `values`; for an even number of values, the upper of the two middle ones. Reorders
/// `values`, which must not be empty.
template <class Number>
Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Ratio of the standard deviation of a normal distribution to its median absolute deviation.
inline constexpr double sigma_of_median_deviation = 1.4826;

}  // namespace tofmap
