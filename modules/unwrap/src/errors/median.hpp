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

/// The median of numbers that are not negative, of an even number the upper of the two middle ones.
/// There must be one at least. Linear in time, without branches that depend on the numbers: they
/// are counted by their leading bits, which are ordered as they are, and only those that share
/// them with the median are sorted.
inline float median_of_positive(std::span<const float> values) {
  constexpr unsigned dropped_bits = 19;  // leaves the exponent and four digits
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
