// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "common/phasor_math.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr double radians_per_cycle = 2 * std::numbers::pi;

TEST(PhasorMath, CosineAndSineAgreeWithTheLibrary) {
  for (float x = -1.5F; x < 2; x += 0.00037F) {
    EXPECT_NEAR(cos_of_cycles(x), std::cos(radians_per_cycle * x), 1e-6) << x;
    EXPECT_NEAR(sin_of_cycles(x), std::sin(radians_per_cycle * x), 1e-6) << x;
  }
}

TEST(PhasorMath, AnglesAgreeWithTheLibrary) {
  for (float x = 0; x < 1; x += 0.00037F) {
    const auto a = static_cast<float>(7 * std::cos(radians_per_cycle * x));
    const auto b = static_cast<float>(7 * std::sin(radians_per_cycle * x));
    const double difference = angle_in_cycles(a, b) - x;
    EXPECT_NEAR(difference - std::round(difference), 0, 1e-6) << x;
    EXPECT_GE(angle_in_cycles(a, b), 0);
    EXPECT_LT(angle_in_cycles(a, b), 1);
  }
  EXPECT_EQ(angle_in_cycles(1, -1e-20F), 0);
}

}  // namespace
}  // namespace tofmap
