// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/phase_noise.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tofmap::peers {
namespace {

TEST(PhaseNoise, ArcSineAgreesWithTheLibrary) {
  for (float u = 0; u <= 1; u += 0.00037F) EXPECT_NEAR(arc_sine(u), std::asin(u), 5e-7) << u;
}

TEST(PhaseNoise, WeakAmplitudesHaveAQuarterTurnAndStrongOnesTheModel) {
  for (const PhaseNoise& noise : kinect_v2_noise) {
    const double unit = amplitude_of_q(noise, 1);
    EXPECT_NEAR(noise.gamma_0 * unit + noise.gamma_1 * unit * unit + noise.gamma_2, 1, 1e-9);
    const auto sigma = [&](double amplitude) {
      return phase_sigma_rad(static_cast<float>(amplitude), static_cast<float>(noise.gamma_0),
                             static_cast<float>(noise.gamma_1), static_cast<float>(noise.gamma_2),
                             static_cast<float>(unit));
    };
    EXPECT_NEAR(sigma(0), std::numbers::pi / 2, 1e-6);
    EXPECT_NEAR(sigma(0.9 * unit), std::numbers::pi / 2, 1e-6);
    const double a = 5 * unit;
    const double q = noise.gamma_0 * a + noise.gamma_1 * a * a + noise.gamma_2;
    EXPECT_NEAR(sigma(a), std::atan(std::sqrt(1 / (q * q - 1))), 1e-5);
  }
}

TEST(PhaseNoise, TheAuthorsGiveTheseAmplitudesOfUnitQ) {
  EXPECT_NEAR(amplitude_of_q(kinect_v2_noise[0], 1), 5.64173671, 1e-5);
  EXPECT_NEAR(amplitude_of_q(kinect_v2_noise[1], 1), 4.31705182, 1e-5);
  EXPECT_NEAR(amplitude_of_q(kinect_v2_noise[2], 1), 6.84453530, 1e-5);
}

}  // namespace
}  // namespace tofmap::peers
