// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace tofmap {

// Functions without branches and library calls, so that the compiler can vectorise loops over them.

/// cos(2π x) for |x| < 2^20, with an absolute error of at most 1e-6. NaN stays NaN.
[[gnu::always_inline]] inline float cos_of_cycles(float x) {
  const float half = x < 0 ? -0.5F : 0.5F;
  const float whole = static_cast<float>(static_cast<std::int32_t>(x + half));
  // cos(2π t) = −sin(2π (|t| − 1/4)), whose argument is within ±1/4.
  const float t = std::fabs(x - whole) - 0.25F;
  const float y = 6.28318531F * t;
  const float square = y * y;
  // Taylor series of sin up to y^11.
  return -y *
         (1 + square * (-0.166666667F +
                        square * (8.33333333e-3F +
                                  square * (-1.98412698e-4F +
                                            square * (2.75573192e-6F - 2.50521084e-8F * square)))));
}

/// sin(2π x), as above.
[[gnu::always_inline]] inline float sin_of_cycles(float x) { return cos_of_cycles(x - 0.25F); }

/// The angle of the vector (a, b) in cycles, [0, 1), with an absolute error of at most 1e-6. NaN if
/// both are zero.
[[gnu::always_inline]] inline float angle_in_cycles(float a, float b) {
  const float abs_a = std::fabs(a);
  const float abs_b = std::fabs(b);
  const float longer = abs_a > abs_b ? abs_a : abs_b;
  const float shorter = abs_a > abs_b ? abs_b : abs_a;
  // atan by Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, equation 4.4.49.
  const float t = shorter / longer;
  const float s = t * t;
  const float series =
      1 +
      s * (-0.3333314528F +
           s * (0.1999355085F +
                s * (-0.1420889944F +
                     s * (0.1065626393F +
                          s * (-0.0752896400F +
                               s * (0.0429096138F + s * (-0.0161657367F + s * 0.0028662257F)))))));
  const float octant = t * series * 0.159154943F;
  const float quadrant = abs_b > abs_a ? 0.25F - octant : octant;
  const float half = a < 0 ? 0.5F - quadrant : quadrant;
  const float full = b < 0 ? 1 - half : half;
  return full >= 1 ? 0.0F : full;
}

}  // namespace tofmap
