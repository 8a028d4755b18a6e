// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/acquisition/phase_error_fit.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

TEST(PhaseErrorFit, FindsOffsetAndHarmonicsInNoise) {
  const PhaseError truth{.offset_m = 0.04, .harmonics = {{4, 0.004, -0.009}}};
  PhaseErrorFit fit({2, 4, 8});
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> phases(0, 1);
  for (int i = 0; i < 100000; ++i) {
    const double phase = phases(random);
    fit.add(phase, truth.at_m(phase) + noise(random));
  }
  const PhaseError found = fit.solve();
  // Noise of 2 cm averages to 0.06 mm over so many samples.
  EXPECT_NEAR(found.offset_m, truth.offset_m, 3e-4);
  ASSERT_EQ(found.harmonics.size(), 1U) << "the others are within their uncertainty";
  EXPECT_EQ(found.harmonics[0].order, 4);
  EXPECT_NEAR(found.harmonics[0].cosine_m, 0.004, 4e-4);
  EXPECT_NEAR(found.harmonics[0].sine_m, -0.009, 4e-4);
  EXPECT_NEAR(fit.residual_rms_m(), 0.02, 5e-4);
}

TEST(PhaseErrorFit, NeedsPhasesAllOverTheCycle) {
  PhaseErrorFit fit({4});
  EXPECT_THROW(fit.solve(), UsageError);
  for (int i = 0; i < 1000; ++i) fit.add(0.25, 0.01);
  EXPECT_THROW(fit.solve(), UsageError);
}

TEST(BeatErrorFit, FindsHarmonicsWithoutKnownRanges) {
  const Modulation modulation{29e6, 31e6};
  const double a_m = modulation.wavelength_a_m();
  const double b_m = modulation.wavelength_b_m();
  // One error in cycles; the harmonics in metres differ by the wavelengths.
  const PhaseError in_cycles{.harmonics = {{4, 0.0004, 0.0018}}};
  BeatErrorFit fit({4, 8}, modulation);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> ranges(0.5, 9);
  for (int i = 0; i < 100000; ++i) {
    const double range_m = ranges(random);
    const double a = range_m / a_m;
    const double b = range_m / b_m;
    const double error_a_m = a_m * in_cycles.at_m(a);
    const double error_b_m = b_m * in_cycles.at_m(b);
    const double offset_m = 0.007;
    fit.add(a, b, error_a_m - error_b_m + offset_m + noise(random));
  }
  const BeatErrorFit::Result found = fit.solve();
  ASSERT_EQ(found.error_a.harmonics.size(), 1U);
  EXPECT_NEAR(found.error_a.harmonics[0].cosine_m, 0.0004 * a_m, 4e-4);
  EXPECT_NEAR(found.error_a.harmonics[0].sine_m, 0.0018 * a_m, 4e-4);
  EXPECT_NEAR(found.error_b.harmonics[0].sine_m, 0.0018 * b_m, 4e-4);
  EXPECT_NEAR(found.offset_m.value, 0.007, 3e-4);
  EXPECT_LT(found.offset_m.sigma, 2e-3);
}

TEST(BeatErrorFit, FindsNothingWhereThereIsNothing) {
  const Modulation modulation{29e6, 31e6};
  BeatErrorFit fit({4, 8}, modulation);
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> ranges(0.5, 9);
  for (int i = 0; i < 20000; ++i) {
    const double range_m = ranges(random);
    fit.add(range_m / modulation.wavelength_a_m(), range_m / modulation.wavelength_b_m(),
            noise(random));
  }
  EXPECT_TRUE(fit.solve().error_a.harmonics.empty());
}

}  // namespace
}  // namespace tofmap
