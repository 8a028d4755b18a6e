// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/phase_error_fit.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr Modulation modulation{29e6, 31e6};
constexpr int pair_count = 100000;
constexpr double noise_m = 0.02;

/// What a camera with an error measures at a range: its error is a function of the phase that it
/// measures, hence the iteration.
double measured_m(double range_m, double wavelength_m, const PhaseError& error) {
  double measured = range_m;
  for (int i = 0; i < 20; ++i) measured = range_m + error.at_m(measured / wavelength_m);
  return measured;
}

/// Pairs of ranges all over 0.5–9 m, seen with errors and noise.
std::vector<RangePair> pairs_of(const PhaseError& error_a, const PhaseError& error_b,
                                bool ranges_are_known, int count = pair_count) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, noise_m);
  std::uniform_real_distribution<double> ranges(0.5, 9);
  std::vector<RangePair> pairs;
  for (int i = 0; i < count; ++i) {
    const double range_m = ranges(random);
    const double a_m = measured_m(range_m, modulation.wavelength_a_m(), error_a) + noise(random);
    const double b_m = measured_m(range_m, modulation.wavelength_b_m(), error_b) + noise(random);
    const double reference_m = ranges_are_known ? range_m : (a_m + b_m) / 2;
    pairs.push_back(
        {static_cast<float>(a_m), static_cast<float>(b_m), static_cast<float>(reference_m)});
  }
  return pairs;
}

PhaseErrorFitOptions orders(std::vector<int> values) { return {.orders = std::move(values)}; }

/// Metres, of the error of one frequency; the same in cycles at the other.
PhaseError in_cycles(double wavelength_m) {
  return {.harmonics = {{4, 0.0004 * wavelength_m, 0.0058 * wavelength_m}}};
}

void expect_harmonic_4(const PhaseError& found, const PhaseError& truth) {
  ASSERT_EQ(found.harmonics.size(), 1U) << "the others are within their uncertainty";
  EXPECT_EQ(found.harmonics[0].order, 4);
  // Noise of 2 cm averages to 0.1 mm over so many pairs; smeared by it over the phase, 3 cm lose
  // their hundredth part.
  EXPECT_NEAR(found.harmonics[0].cosine_m, truth.harmonics[0].cosine_m, 7e-4);
  EXPECT_NEAR(found.harmonics[0].sine_m, truth.harmonics[0].sine_m, 7e-4);
}

TEST(FitToReferences, FindsOffsetsAndHarmonicsInNoise) {
  const PhaseError a{.offset_m = 0.04, .harmonics = {{4, 0.004, -0.009}}};
  const PhaseError b{.offset_m = -0.02, .harmonics = {{4, 0.01, 0.02}}};
  const PhaseErrorFit found =
      fit_to_references(pairs_of(a, b, true), modulation, orders({2, 4, 8}));
  EXPECT_NEAR(found.error_a.offset_m, 0.04, 5e-4);
  EXPECT_NEAR(found.error_b.offset_m, -0.02, 5e-4);
  expect_harmonic_4(found.error_a, a);
  expect_harmonic_4(found.error_b, b);
  EXPECT_NEAR(found.offset_m.value, 0.06, 7e-4);
  EXPECT_LT(found.offset_m.sigma, 1e-3);
  EXPECT_NEAR(found.residual_rms_m, noise_m, 5e-4);
}

TEST(FitToReferences, LeavesOutWhatIsFarOff) {
  std::vector<RangePair> pairs = pairs_of({.offset_m = 0.3}, {}, true);
  for (std::size_t i = 0; i < pairs.size(); i += 10) pairs[i].a_m += 1.5F;  // a mixed pixel
  const PhaseErrorFit found = fit_to_references(pairs, modulation, orders({4}));
  EXPECT_NEAR(found.error_a.offset_m, 0.3, 5e-4);
}

TEST(FitToReferences, NeedsPhasesAllOverTheCycle) {
  EXPECT_THROW(fit_to_references({}, modulation, orders({4})), InputError);
  const std::vector<RangePair> alike(1000, {2.01F, 2, 2});
  EXPECT_THROW(fit_to_references(alike, modulation, orders({4})), InputError);
}

TEST(FitToBeat, FindsHarmonicsWithoutKnownRanges) {
  const PhaseError a = in_cycles(modulation.wavelength_a_m());
  const PhaseError b = in_cycles(modulation.wavelength_b_m());
  const PhaseErrorFit found = fit_to_beat(pairs_of(a, b, false), modulation, orders({4, 8}));
  expect_harmonic_4(found.error_a, a);
  expect_harmonic_4(found.error_b, b);
}

TEST(FitToBeat, FindsByHowMuchOffsetsDiffer) {
  const PhaseErrorFit found =
      fit_to_beat(pairs_of({.offset_m = 0.007}, {}, false), modulation, orders({4}));
  EXPECT_NEAR(found.offset_m.value, 0.007, 3e-4);
  EXPECT_LT(found.offset_m.sigma, 2e-3);
  EXPECT_EQ(found.error_a.offset_m, 0) << "motion may have feigned it";
}

TEST(FitToBeat, FindsNothingWhereThereIsNothing) {
  const PhaseErrorFit found =
      fit_to_beat(pairs_of({}, {}, false, 20000), modulation, orders({4, 8}));
  EXPECT_TRUE(found.error_a.harmonics.empty());
}

TEST(AppendRangePairs, TakesTheWrapsThatComeNearestToTheReference) {
  DualFrequencyFrame frame;
  frame.phase_a = ImageF::Constant(1, 4, 0.1F);
  frame.phase_b = ImageF::Constant(1, 4, 0.9F);
  frame.phase_b(0, 1) = NAN;
  ImageF reference_m = ImageF::Constant(1, 4, 10);
  reference_m(0, 2) = NAN;
  std::vector<RangePair> pairs;
  append_range_pairs(frame, modulation, reference_m, 0, 1, pairs);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NEAR(pairs[0].a_m, 2.1 * modulation.wavelength_a_m(), 1e-5);
  EXPECT_NEAR(pairs[0].b_m, 1.9 * modulation.wavelength_b_m(), 1e-5);
  append_range_pairs(frame, modulation, reference_m, 3, 2, pairs);
  EXPECT_EQ(pairs.size(), 3U);
}

}  // namespace
}  // namespace tofmap
