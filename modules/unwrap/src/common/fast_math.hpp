// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <tofmap/core/frequency_residual.hpp>

namespace tofmap {

// Functions without branches and library calls, so that the compiler can vectorise loops over them.

/// exp(x) for x ≤ 0, with a relative error of at most 3e-7; about 1e-38 for x below −87.
[[gnu::always_inline]] inline float exp_of_negative(float x) {
  constexpr float log2_e = 1.44269504F;
  const float clamped = x > -87.0F ? x : -87.0F;
  const float exponent = clamped * log2_e;
  const auto whole = static_cast<std::int32_t>(exponent - 0.5F);  // rounds to nearest for x ≤ 0
  const float t = (exponent - static_cast<float>(whole)) * 0.693147181F;
  // Taylor series of e^t up to t^6; |t| ≤ ln 2 / 2.
  const float series =
      1 +
      t * (1 + t * (0.5F + t * (0.166666667F +
                                t * (0.0416666667F + t * (0.00833333333F + t * 0.00138888889F)))));
  return series * std::bit_cast<float>((whole + 127) << 23);
}

/// log2(x) for a positive normal number, with an absolute error of at most 2e-6.
[[gnu::always_inline]] inline float log2_of(float x) {
  constexpr std::uint32_t mantissa_bits = 0x7fffffU;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23U) - 127);
  const float m = std::bit_cast<float>((bits & mantissa_bits) | 0x3f800000U);
  // log2(m / √2) = 2 / ln 2 (y + y³/3 + y⁵/5 + …) with y = (m − √2) / (m + √2).
  constexpr float root = 1.41421356F;
  const float y = (m - root) / (m + root);
  const float square = y * y;
  return exponent + 0.5F + 2.88539008F * y * (1 + square * (0.333333333F + 0.2F * square));
}

/// Replaces `number` by `other` on a condition, in loops. GCC would compile a conditional
/// expression into masked loads and stores, which some processors execute slowly.
[[gnu::always_inline]] inline void replace_if(bool condition, float other, float& number) {
  const std::uint32_t mask = condition ? 0xffffffffU : 0U;
  const auto before = std::bit_cast<std::uint32_t>(number);
  number = std::bit_cast<float>((std::bit_cast<std::uint32_t>(other) & mask) | (before & ~mask));
}

/// The smallest of `values`, whose number must be a power of two. Overwrites `values`.
template <std::size_t lanes>
[[gnu::always_inline]] inline float least_of(std::array<float, lanes>& values) {
  for (std::size_t half = lanes / 2; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      values[k] = values[k + half] < values[k] ? values[k + half] : values[k];
    }
  }
  return values[0];
}

/// The upper half of a float, which keeps 8 binary digits of precision. It halves the memory
/// traffic of messages and unary factors.
using BFloat16 = std::uint16_t;

[[gnu::always_inline]] inline float to_float(BFloat16 half) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16U);
}

/// Converts a positive number, rounded to nearest.
[[gnu::always_inline]] inline BFloat16 to_bfloat16(float value) {
  return static_cast<BFloat16>((std::bit_cast<std::uint32_t>(value) + 0x8000U) >> 16U);
}

inline constexpr BFloat16 bfloat16_one = 0x3f80;

}  // namespace tofmap
