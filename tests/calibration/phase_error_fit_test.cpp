// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/consistency.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/calibration/phase_error_fit.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

const Modulation modulation{29e6, 31e6};
constexpr int sample_count = 100000;
constexpr double noise_m = 0.02;

/// What a camera with an error measures at a range: its error is a function of the phase that it
/// measures, hence the iteration.
double measured_m(double range_m, double wavelength_m, const PhaseError& error) {
  double measured = range_m;
  for (int i = 0; i < 20; ++i) measured = range_m + error.at_m(measured / wavelength_m);
  return measured;
}

/// Samples of ranges all over 0.5–9 m, seen with errors and noise, which is evenly spread over
/// surfaces from bright to dark.
struct Sampling {
  bool ranges_are_known = true;
  int count = sample_count;
  double least_noise_m = noise_m;
  double most_noise_m = noise_m;
};

std::vector<RangeSample> samples_of(const PhaseError& error_a, const PhaseError& error_b,
                                    const Sampling& sampling = {}) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> ranges(0.5, 9);
  std::uniform_real_distribution<double> noises(sampling.least_noise_m, sampling.most_noise_m);
  std::vector<RangeSample> samples;
  for (int i = 0; i < sampling.count; ++i) {
    const double range_m = ranges(random);
    const double sigma_m = noises(random);
    const double a_m =
        measured_m(range_m, modulation.wavelength_m(0), error_a) + sigma_m * normal(random);
    const double b_m =
        measured_m(range_m, modulation.wavelength_m(1), error_b) + sigma_m * normal(random);
    const double reference_m = sampling.ranges_are_known ? range_m : (a_m + b_m) / 2;
    constexpr double unit = 7;  // noise is known up to a factor
    const auto relative = static_cast<float>(unit * sigma_m);
    samples.push_back({static_cast<float>(a_m), static_cast<float>(b_m),
                       static_cast<float>(reference_m), relative, relative});
  }
  return samples;
}

constexpr Sampling unknown_ranges{.ranges_are_known = false};

PhaseErrorFitOptions orders(std::vector<int> values) { return {.orders = std::move(values)}; }

/// Metres, of the error of one frequency; the same in cycles at the other.
PhaseError in_cycles(double wavelength_m) {
  return {.harmonics = {{4, 0.0004 * wavelength_m, 0.0058 * wavelength_m}}};
}

void expect_harmonic_4(const PhaseError& found, const PhaseError& truth) {
  ASSERT_EQ(found.harmonics.size(), 1U) << "the others are within their uncertainty";
  EXPECT_EQ(found.harmonics[0].order, 4);
  // Noise of 2 cm averages to 0.1 mm over so many samples.
  EXPECT_NEAR(found.harmonics[0].cosine_m, truth.harmonics[0].cosine_m, 7e-4);
  EXPECT_NEAR(found.harmonics[0].sine_m, truth.harmonics[0].sine_m, 7e-4);
}

TEST(FitToReferences, FindsOffsetsAndHarmonicsInNoise) {
  const PhaseError a{.offset_m = 0.04, .harmonics = {{4, 0.004, -0.009}}};
  const PhaseError b{.offset_m = -0.02, .harmonics = {{4, 0.01, 0.02}}};
  const PhaseErrorFit found = fit_to_references(samples_of(a, b), modulation, orders({2, 4, 8}));
  EXPECT_NEAR(found.error_a.offset_m, 0.04, 5e-4);
  EXPECT_NEAR(found.error_b.offset_m, -0.02, 5e-4);
  expect_harmonic_4(found.error_a, a);
  expect_harmonic_4(found.error_b, b);
  EXPECT_NEAR(found.offset_m.value, 0.06, 7e-4);
  EXPECT_LT(found.offset_m.sigma, 1e-3);
  EXPECT_NEAR(found.residual_rms_m, noise_m, 5e-4);
}

/// How large harmonic 4 is found where most surfaces are dark, over how large it is.
double share_found(const PhaseErrorFit& found, const PhaseError& truth) {
  for (const WiggleHarmonic& one : found.error_a.harmonics) {
    if (one.order != 4) continue;
    return std::hypot(one.cosine_m, one.sine_m) /
           std::hypot(truth.harmonics[0].cosine_m, truth.harmonics[0].sine_m);
  }
  return 0;
}

TEST(FitToReferences, IsNotMisledByDarkSurfaces) {
  // Many are farther off than what counts as wrong, 0.15 m: those that are not lean to the median.
  const PhaseError a = in_cycles(modulation.wavelength_m(0));
  const PhaseError b = in_cycles(modulation.wavelength_m(1));
  const auto samples = samples_of(a, b, {.least_noise_m = 0.005, .most_noise_m = 0.3});
  EXPECT_NEAR(share_found(fit_to_references(samples, modulation, orders({4})), a), 1, 0.02);
}

TEST(FitToResidual, IsNotMisledByDarkSurfaces) {
  const PhaseError a = in_cycles(modulation.wavelength_m(0));
  const PhaseError b = in_cycles(modulation.wavelength_m(1));
  const auto samples =
      samples_of(a, b, {.ranges_are_known = false, .least_noise_m = 0.005, .most_noise_m = 0.3});
  EXPECT_NEAR(share_found(fit_to_residual(samples, modulation, orders({4})), a), 1, 0.02);
  // Nor where all are alike, and only how far they spread tells their noise.
  const auto dark =
      samples_of(a, b, {.ranges_are_known = false, .least_noise_m = 0.05, .most_noise_m = 0.05});
  EXPECT_NEAR(share_found(fit_to_residual(dark, modulation, orders({4})), a), 1, 0.03)
      << "their spread has the harmonic in it";
}

TEST(FitToReferences, LeavesOutWhatIsFarOff) {
  std::vector<RangeSample> samples = samples_of({.offset_m = 0.3}, {});
  for (std::size_t i = 0; i < samples.size(); i += 10) samples[i].a_m += 1.5F;  // a mixed pixel
  const PhaseErrorFit found = fit_to_references(samples, modulation, orders({4}));
  EXPECT_NEAR(found.error_a.offset_m, 0.3, 5e-4);
}

TEST(FitToReferences, NeedsPhasesAllOverTheCycle) {
  EXPECT_THROW(fit_to_references({}, modulation, orders({4})), InputError);
  const std::vector<RangeSample> alike(1000, {2.01F, 2, 2});
  EXPECT_THROW(fit_to_references(alike, modulation, orders({4})), InputError);
}

TEST(FitToResidual, FindsHarmonicsWithoutKnownRanges) {
  const PhaseError a = in_cycles(modulation.wavelength_m(0));
  const PhaseError b = in_cycles(modulation.wavelength_m(1));
  const PhaseErrorFit found =
      fit_to_residual(samples_of(a, b, unknown_ranges), modulation, orders({4, 8}));
  expect_harmonic_4(found.error_a, a);
  expect_harmonic_4(found.error_b, b);
}

TEST(FitToResidual, FindsAHarmonicOfSixCentimetres) {
  const auto large = [](double wavelength_m) {
    return PhaseError{.harmonics = {{4, 0.001 * wavelength_m, 0.012 * wavelength_m}}};
  };
  const PhaseError a = large(modulation.wavelength_m(0));
  const PhaseError b = large(modulation.wavelength_m(1));
  const PhaseErrorFit found =
      fit_to_residual(samples_of(a, b, unknown_ranges), modulation, orders({4}));
  // The noise of a phase also changes the error at that phase, which biases the harmonic by 2 %.
  EXPECT_NEAR(share_found(found, a), 1, 0.03);
}

TEST(FitToResidual, FindsByHowMuchOffsetsDiffer) {
  const PhaseErrorFit found =
      fit_to_residual(samples_of({.offset_m = 0.007}, {}, unknown_ranges), modulation, orders({4}));
  EXPECT_NEAR(found.offset_m.value, 0.007, 3e-4);
  EXPECT_LT(found.offset_m.sigma, 2e-3);
  EXPECT_EQ(found.error_a.offset_m, 0) << "motion may have caused it";
}

TEST(FitToResidual, FindsNothingWhereThereIsNothing) {
  const PhaseErrorFit found = fit_to_residual(
      samples_of({}, {}, {.ranges_are_known = false, .count = 20000}), modulation, orders({4, 8}));
  EXPECT_TRUE(found.error_a.harmonics.empty());
}

/// As many samples as a few frames give. All samples of a surface share one error at each
/// frequency; there are thirty to a surface, as the fit allows for.
std::vector<RangeSample> samples_of_surfaces(double offset_a_m, unsigned seed) {
  constexpr int surfaces = 100;
  constexpr int samples_each = 30;
  std::mt19937 random(seed);
  std::normal_distribution<double> error_m(0, noise_m);
  std::uniform_real_distribution<double> ranges(0.5, 9);
  std::vector<RangeSample> samples;
  for (int i = 0; i < surfaces; ++i) {
    const double error_a_m = offset_a_m + error_m(random);
    const double error_b_m = error_m(random);
    for (int j = 0; j < samples_each; ++j) {
      const double range_m = ranges(random);
      samples.push_back({static_cast<float>(range_m + error_a_m),
                         static_cast<float>(range_m + error_b_m), static_cast<float>(range_m)});
    }
  }
  return samples;
}

/// Of the offset between both frequencies, over 500 draws.
template <class Fit>
void expect_consistent_offset(const Fit& fit) {
  constexpr double offset_a_m = 0.01;
  test::Consistency consistency;
  for (unsigned seed = 0; seed < 500; ++seed) {
    const PhaseErrorFit found =
        fit(samples_of_surfaces(offset_a_m, seed), modulation, PhaseErrorFitOptions{});
    consistency.add(found.offset_m.value - offset_a_m, found.offset_m.sigma);
  }
  EXPECT_GT(consistency.mean_nees(), consistency.lower_bound());
  EXPECT_LT(consistency.mean_nees(), consistency.upper_bound());
}

TEST(FitToReferences, IsAsFarOffAsItSays) { expect_consistent_offset(fit_to_references); }

TEST(FitToResidual, IsAsFarOffAsItSays) { expect_consistent_offset(fit_to_residual); }

TEST(AppendRangeSamples, TakesTheWrapsThatComeNearestToTheReference) {
  Frame frame = blank_frame(2);
  frame.phases[0] = ImageF::Constant(1, 4, 0.1F);
  frame.phases[1] = ImageF::Constant(1, 4, 0.9F);
  frame.phases[1](0, 1) = NAN;
  ImageF reference_m = ImageF::Constant(1, 4, 10);
  reference_m(0, 2) = NAN;
  SensorModel sensor;
  sensor.modulation = modulation;
  std::vector<RangeSample> samples;
  append_range_samples(frame, sensor, reference_m, 1, 0, 1, samples);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_NEAR(samples[0].a_m, 2.1 * modulation.wavelength_m(0), 1e-5);
  EXPECT_NEAR(samples[0].b_m, 1.9 * modulation.wavelength_m(1), 1e-5);
  append_range_samples(frame, sensor, reference_m, 1, 3, 2, samples);
  EXPECT_EQ(samples.size(), 3U);
}

TEST(AppendRangeSamples, LeavesSaturatedPixelsOut) {
  Frame frame = blank_frame(2);
  frame.phases[0] = ImageF::Constant(1, 3, 0.1F);
  frame.phases[1] = frame.phases[0];
  frame.amplitudes[0] = ImageF::Constant(1, 3, 100);
  frame.amplitudes[1] = frame.amplitudes[0];
  frame.amplitudes[0](0, 0) = 1000;
  frame.amplitudes[1](0, 2) = 1000;
  SensorModel sensor;
  sensor.modulation = modulation;
  sensor.saturation_amplitude = 1000;
  std::vector<RangeSample> samples;
  append_range_samples(frame, sensor, ImageF::Constant(1, 3, 10), 1, 0, 1, samples);
  EXPECT_EQ(samples.size(), 1U);
}

}  // namespace
}  // namespace tofmap
