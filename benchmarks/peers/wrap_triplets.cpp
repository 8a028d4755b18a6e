// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/wrap_triplets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap::peers {
namespace {

constexpr std::int64_t most_wraps = 255;

/// The frequencies as multiples of their greatest common divisor, which is returned in Hz.
double divide_by_common(const std::array<double, 3>& frequencies_hz,
                        std::array<std::int64_t, 3>& multiples) {
  constexpr double unit_hz = 1000;
  std::int64_t common = 0;
  for (std::size_t m = 0; m < 3; ++m) {
    multiples[m] = std::llround(frequencies_hz[m] / unit_hz);
    common = std::gcd(common, multiples[m]);
  }
  for (std::int64_t& multiple : multiples) {
    multiple /= std::max<std::int64_t>(common, 1);
    if (multiple < 1 || multiple > most_wraps)
      throw UsageError(
          fmt::format("frequencies_hz: {} Hz, {} Hz and {} Hz must have a non-ambiguity range in "
                      "which each wraps 1 to {} times",
                      frequencies_hz[0], frequencies_hz[1], frequencies_hz[2], most_wraps));
  }
  return static_cast<double>(common) * unit_hz;
}

/// Appends `counts` and every triplet in which a part of the frequencies in `wrapping` has wrapped
/// once more.
void append_part_wrapped(const WrapTriplet& counts, unsigned wrapping,
                         std::vector<WrapTriplet>& out) {
  for (unsigned part = wrapping & (wrapping - 1); part > 0; part = (part - 1) & wrapping) {
    WrapTriplet one = counts;
    for (unsigned m = 0; m < 3; ++m)
      one[m] = static_cast<std::uint8_t>(one[m] + ((part >> m) & 1U));
    out.push_back(one);
  }
}

}  // namespace

WrapTriplets wrap_triplets(const std::array<double, 3>& frequencies_hz, double speed_of_light_m_s) {
  std::array<std::int64_t, 3> multiples{};
  const double common_hz = divide_by_common(frequencies_hz, multiples);
  WrapTriplets out;
  const std::int64_t steps = std::lcm(std::lcm(multiples[0], multiples[1]), multiples[2]);
  for (std::size_t m = 0; m < 3; ++m)
    out.multiplier[m] = static_cast<double>(steps) / static_cast<double>(multiples[m]);
  out.non_ambiguity_range_m = speed_of_light_m_s / (2 * common_hz);

  WrapTriplet counts{};
  out.triplets.push_back(counts);
  for (std::int64_t step = 1; step < steps; ++step) {
    unsigned wrapping = 0;
    for (unsigned m = 0; m < 3; ++m)
      if (step % (steps / multiples[m]) == 0) wrapping |= 1U << m;
    if (wrapping == 0) continue;
    append_part_wrapped(counts, wrapping, out.triplets);
    for (unsigned m = 0; m < 3; ++m)
      counts[m] = static_cast<std::uint8_t>(counts[m] + ((wrapping >> m) & 1U));
    out.triplets.push_back(counts);
  }
  return out;
}

}  // namespace tofmap::peers
