// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tofmap {

/// The median of non-negative numbers; for an even count, the upper of the two middle values.
/// `values` must not be empty. Takes linear time, with few branches that depend on the values: a
/// histogram over the leading bits, whose order is that of the numbers, finds the bin of the
/// median, and only the values of that bin are partially sorted.
inline float median_of_positive(std::span<const float> values) {
  constexpr unsigned dropped_bits = 19;  // keeps the exponent and four bits of the mantissa
  constexpr std::size_t bins = 1U << (31U - dropped_bits);
  const auto bin_of = [](float value) {
    return std::bit_cast<std::uint32_t>(value) >> dropped_bits;
  };
  std::array<std::uint32_t, bins> members{};
  for (const float value : values) ++members[bin_of(value)];
  std::size_t rank = values.size() / 2;
  std::size_t bin = 0;
  while (rank >= members[bin]) rank -= members[bin++];
  std::vector<float> candidates;
  candidates.reserve(members[bin]);
  for (const float value : values) {
    if (bin_of(value) == bin) candidates.push_back(value);
  }
  const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(candidates.begin(), middle, candidates.end());
  return *middle;
}

}  // namespace tofmap
