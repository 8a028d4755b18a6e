// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "common/frequency_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace tofmap {
std::vector<std::size_t> counting_order(const UnwrapLimits& limits) {
  std::vector<std::size_t> order(limits.frequencies());
  std::iota(order.begin(), order.end(), 0);
  const std::size_t best = counted_frequency(limits.wavelengths_m);
  if (limits.pair(best, best).count_a > invalid_wrap_count) return order;
  const auto counted = order.begin() + static_cast<std::ptrdiff_t>(best);
  std::rotate(order.begin(), counted, counted + 1);
  return order;
}

UnwrapLimits in_order(const UnwrapLimits& limits, const std::vector<std::size_t>& order) {
  UnwrapLimits out = limits;
  out.wavelengths_m.clear();
  for (const std::size_t f : order) out.wavelengths_m.push_back(limits.wavelengths_m[f]);
  out.count = limits.pair(order.front(), order.front()).count_a;
  return out;
}

void count_at_ranges(const ImageF& phase, double wavelength_m, RangeImage& image) {
  for (Eigen::Index i = 0; i < phase.size(); ++i) {
    if (image.wrap_count.data()[i] == invalid_wrap_count) continue;
    const double cycles = image.range_m.data()[i] / wavelength_m - phase.data()[i];
    image.wrap_count.data()[i] =
        static_cast<std::uint8_t>(std::clamp(std::lround(cycles), 0L, invalid_wrap_count - 1L));
  }
}

}  // namespace tofmap
