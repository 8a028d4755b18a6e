// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

struct Pair {
  const char* name;
  double frequency_a_hz;
  double frequency_b_hz;
  int counts;  ///< of A up to 37 m

  Modulation modulation() const { return {frequency_a_hz, frequency_b_hz}; }
};

/// Without the shortcut: of all counts of B the one whose range is the nearest to A's.
double nearest_difference_m(const Pair& pair, double cycles_a, double phase_b) {
  const double range_a_m = cycles_a * pair.modulation().wavelength_m(0);
  const double wavelength_b_m = pair.modulation().wavelength_m(1);
  double nearest_m = 1e9;
  for (int n_b = -2; n_b < 40; ++n_b) {
    const double difference_m = range_a_m - (phase_b + n_b) * wavelength_b_m;
    if (std::abs(difference_m) < std::abs(nearest_m)) nearest_m = difference_m;
  }
  return nearest_m;
}

class FrequencyResidual : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Pairs, FrequencyResidual,
                         testing::Values(Pair{"29and31MHz", 29e6, 31e6, 7},
                                         Pair{"31and29MHz", 31e6, 29e6, 7},
                                         Pair{"80and100MHz", 80e6, 100e6, 19},
                                         Pair{"16and80MHz", 16e6, 80e6, 4}),
                         [](const auto& pair) { return std::string(pair.param.name); });

TEST_P(FrequencyResidual, IsTheDistanceToTheNearestRangeThatBAllows) {
  const Modulation modulation = GetParam().modulation();
  const double wavelength_b_m = modulation.wavelength_m(1);
  const auto ratio = static_cast<float>(modulation.wavelength_m(0) / wavelength_b_m);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> phase(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const double phase_a = phase(random);
    const double phase_b = phase(random);
    for (int n = 0; n < GetParam().counts; ++n) {
      const double expected_m = nearest_difference_m(GetParam(), phase_a + n, phase_b);
      EXPECT_NEAR(
          frequency_residual_m(modulation.wavelength_m(0), wavelength_b_m, phase_a + n, phase_b),
          expected_m, 1e-9);
      const float cycles = frequency_residual_cycles(static_cast<float>(phase_a + n),
                                                     static_cast<float>(phase_b), ratio);
      // Floats of some twenty cycles have steps of 2e-6.
      EXPECT_NEAR(cycles, expected_m / wavelength_b_m, 1e-5);
    }
  }
}

TEST_P(FrequencyResidual, VanishesAtTheRightCountOfEveryRange) {
  const Modulation modulation = GetParam().modulation();
  const double wavelength_a_m = modulation.wavelength_m(0);
  const double wavelength_b_m = modulation.wavelength_m(1);
  for (double range_m = 0.1; range_m < 35; range_m += 0.37) {
    const double cycles_b = range_m / wavelength_b_m;
    EXPECT_NEAR(frequency_residual_m(wavelength_a_m, wavelength_b_m, range_m / wavelength_a_m,
                                     cycles_b - std::floor(cycles_b)),
                0, 1e-9);
  }
}

TEST_P(FrequencyResidual, MovesWithAWrapAsTheShiftSays) {
  const Modulation modulation = GetParam().modulation();
  const double ratio = modulation.wavelength_m(0) / modulation.wavelength_m(1);
  for (int wraps = -4; wraps <= 4; ++wraps) {
    const double before_m = nearest_difference_m(GetParam(), 5.3, 0.1);
    const double after_m = nearest_difference_m(GetParam(), 5.3 + wraps, 0.1);
    const double moved_cycles = (after_m - before_m) / modulation.wavelength_m(1);
    const double shift_cycles = residual_shift_cycles(ratio, wraps);
    EXPECT_NEAR(std::remainder(moved_cycles - shift_cycles, 1), 0, 1e-9) << wraps;
    EXPECT_LE(std::abs(shift_cycles), 0.5);
  }
}

TEST_P(FrequencyResidual, OfAWrongCountIsAtLeastTheStep) {
  const Modulation modulation = GetParam().modulation();
  const double wavelength_a_m = modulation.wavelength_m(0);
  const double wavelength_b_m = modulation.wavelength_m(1);
  const int counts = GetParam().counts;
  double least_m = wavelength_b_m;
  for (int right = 0; right < counts; ++right) {
    const double range_m = (right + 0.4) * wavelength_a_m;
    const double phase_b = range_m / wavelength_b_m - std::floor(range_m / wavelength_b_m);
    for (int wrong = 0; wrong < counts; ++wrong) {
      const double size_m = std::abs(nearest_difference_m(GetParam(), wrong + 0.4, phase_b));
      if (size_m > indistinguishable_cycles * wavelength_b_m) least_m = std::min(least_m, size_m);
    }
  }
  EXPECT_NEAR(residual_step_m(wavelength_a_m, wavelength_b_m, counts), least_m, 1e-9);
}

TEST(ResidualStep, IsTheDifferenceOfWavelengthsOfANearPair) {
  const Modulation modulation{29e6, 31e6};
  const double a_m = modulation.wavelength_m(0);
  const double b_m = modulation.wavelength_m(1);
  EXPECT_NEAR(residual_step_m(a_m, b_m, 4), a_m - b_m, 1e-9);
  EXPECT_NEAR(residual_step_m(b_m, a_m, 4), a_m - b_m, 1e-9);
}

TEST(ResidualStep, IsAQuarterWavelengthAt80And100MHzThoughFourWrapsMakeNoChange) {
  const Modulation modulation{80e6, 100e6};
  EXPECT_NEAR(residual_step_m(modulation.wavelength_m(0), modulation.wavelength_m(1), 9),
              modulation.wavelength_m(1) / 4, 1e-9);
}

TEST(ResidualStep, IsAWholeWavelengthWhereNoCountChangesTheResidual) {
  const Modulation multiple{16e6, 80e6};
  EXPECT_EQ(residual_step_m(multiple.wavelength_m(0), multiple.wavelength_m(1), 8),
            multiple.wavelength_m(1));
  const Modulation single{29e6, 31e6};
  EXPECT_EQ(residual_step_m(single.wavelength_m(0), single.wavelength_m(1), 1),
            single.wavelength_m(1))
      << "one count has no runner_up";
}

TEST(FrequencyResidualOfNothing, IsNaN) {
  EXPECT_TRUE(std::isnan(frequency_residual_m(5, 4.8, NAN, 0.3)));
  EXPECT_TRUE(std::isnan(frequency_residual_m(5, 4.8, 1.3, NAN)));
}

}  // namespace
}  // namespace tofmap
