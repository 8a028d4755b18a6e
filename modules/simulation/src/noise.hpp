// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

namespace tofmap {

/// Hashes a number: equal arguments give equal results, and different arguments give results that
/// look independent (the finaliser of SplitMix64; Steele, Lea and Flood, 'Fast splittable
/// pseudorandom number generators', OOPSLA 2014).
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// A pseudorandom number in [0, 1), uniformly distributed over keys.
inline double share_of(std::uint64_t key) { return static_cast<double>(mix(key) >> 11U) * 0x1p-53; }

/// Complex Gaussian noise with a standard deviation of 1 in each component. It depends only on key
/// and counter, so that neither the order in which pixels are computed nor the number of threads
/// matters.
inline std::complex<double> complex_noise(std::uint64_t key, std::uint64_t counter) {
  const std::uint64_t first = mix(key ^ mix(2 * counter));
  const std::uint64_t second = mix(key ^ mix(2 * counter + 1));
  constexpr double unit = 0x1p-53;
  const double radius = std::sqrt(-2 * std::log((static_cast<double>(first >> 11U) + 1) * unit));
  return std::polar(radius, 2 * std::numbers::pi * static_cast<double>(second >> 11U) * unit);
}

}  // namespace tofmap
