// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/printed_terms.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/jump/jump_estimate.hpp>

namespace tofmap {
namespace {

TEST(NeighbourVariance, IsThatOfAllDifferencesOfTheWrappedImage) {
  ImageF phase(2, 2);
  phase << 0.1F, 0.9F, 0.2F, 0.4F;
  // Differences 0.8, 0.2 and 0.1, −0.5: their mean is 0.15, their mean square 0.235.
  EXPECT_NEAR(neighbour_variance_cycles2(phase), 0.235 - 0.15 * 0.15, 1e-7);
}

TEST(NeighbourVariance, LeavesOutPairsWithoutAReturn) {
  ImageF phase(2, 3);
  phase << 0.1F, 0.9F, NAN, 0.2F, 0.4F, NAN;
  EXPECT_NEAR(neighbour_variance_cycles2(phase), 0.235 - 0.15 * 0.15, 1e-7);
}

TEST(NeighbourVariance, OfAnImageWithoutContrastIsThatOfItsQuantisation) {
  const double least = 1 / (65535.0 * 65535.0);
  EXPECT_EQ(neighbour_variance_cycles2(ImageF::Constant(4, 4, 0.3F)), least);
  EXPECT_EQ(neighbour_variance_cycles2(ImageF::Constant(4, 4, NAN)), least);
  EXPECT_EQ(neighbour_variance_cycles2(ImageF::Constant(1, 1, 0.3F)), least);
}

constexpr double longer_m = 5.16883548;   // of 29 MHz
constexpr double shorter_m = 4.83536223;  // of 31 MHz

/// One pixel with these wrapped ranges, by equation 2 with τ halfway.
int count_of(double a_m, double b_m, double wavelength_a_m = longer_m,
             double wavelength_b_m = shorter_m) {
  const PairLimits limits{.wavelength_a_m = wavelength_a_m, .wavelength_b_m = wavelength_b_m};
  Frame frame = blank_frame(2);
  frame.phases[0] = ImageF::Constant(1, 1, static_cast<float>(a_m / wavelength_a_m));
  frame.phases[1] = ImageF::Constant(1, 1, static_cast<float>(b_m / wavelength_b_m));
  return threshold_counts(frame, limits, halfway_threshold_m(limits))(0, 0);
}

TEST(EquationTwo, TellsTheThreeRegionsOfFigureFour) {
  EXPECT_EQ(count_of(3, 3), 0);
  EXPECT_EQ(count_of(5, 5 - shorter_m), 0) << "B is wrapped, A is not: a mod λ_B is b";
  EXPECT_EQ(count_of(8 - longer_m, 8 - shorter_m), 1) << "both are wrapped";
}

TEST(EquationTwo, HasItsThresholdHalfway) {
  EXPECT_NEAR(halfway_threshold_m({.wavelength_a_m = longer_m, .wavelength_b_m = shorter_m}),
              0.166737, 1e-6);
  EXPECT_EQ(count_of(2, 2.16), 0);
  EXPECT_EQ(count_of(2, 2.17), 1);
  EXPECT_EQ(count_of(2, 1.84), 0);
  EXPECT_EQ(count_of(2, 1.83), 1) << "d knows no sign";
}

TEST(EquationTwo, TakesNoiseAroundAMultipleOfBForAWrap) {
  // The paper's d is no difference on a circle.
  EXPECT_EQ(count_of(4.83, 0.001), 1);
}

TEST(EquationTwo, HoldsForAnAOfTheShorterWavelength) {
  EXPECT_EQ(count_of(3, 3, shorter_m, longer_m), 0);
  EXPECT_EQ(count_of(5 - shorter_m, 5, shorter_m, longer_m), 1);
  EXPECT_EQ(count_of(8 - shorter_m, 8 - longer_m, shorter_m, longer_m), 1);
}

TEST(EquationTwo, HasNoCountWithoutAReturn) {
  EXPECT_EQ(count_of(NAN, 3), invalid_wrap_count);
  EXPECT_EQ(count_of(3, NAN), invalid_wrap_count);
}

/// A wall at 4.9, 5.1, 5.3, 5.5 m: between the second and the third pixel A wraps.
Frame sloping_row() {
  Frame frame = blank_frame(2);
  frame.phases[0].resize(1, 4);
  frame.phases[1].resize(1, 4);
  for (Eigen::Index u = 0; u < 4; ++u) {
    const double range_m = 4.9 + 0.2 * static_cast<double>(u);
    frame.phases[0](0, u) = static_cast<float>(std::fmod(range_m / longer_m, 1));
    frame.phases[1](0, u) = static_cast<float>(std::fmod(range_m / shorter_m, 1));
  }
  frame.amplitudes[0] = ImageF::Constant(1, 4, 10);
  frame.amplitudes[1] = frame.amplitudes[0];
  return frame;
}

TEST(EvidenceOfPaper, IsThatOfEquationsOneThreeAndFourWithTheVarianceOfTheImage) {
  const Frame frame = sloping_row();
  UnwrapOptions options;
  options.window_px = 2;
  JumpEstimator estimator;
  const JumpEstimate& jumps = estimator.estimate(
      frame, PhaseSigma(frame, {{.scale = 1}, {.scale = 1}}),
      {.wavelength_a_m = longer_m, .wavelength_b_m = shorter_m, .max_range_m = 70, .count_a = 14},
      jump_method(UnwrapMethod::paper), options);
  // Two steps of 0.2 m, and one of 0.2 m less a wavelength: with s = 0.2 / λ_A their mean is
  // s − 1/3, and their variance that of 0, 0 and −1.
  const double variance = 1.0 / 3 - 1.0 / 9;
  const double step = 0.2 / longer_m;
  // At the jump: m_R̂ − m_A is 0 before it, and 1 after it.
  double sum = 0;
  std::array<double, 3> expected{};
  for (int i = -1; i <= 1; ++i) {
    const double f_d = std::exp(-std::pow(step - 1 - i, 2) / (2 * variance));
    const double f_f = std::exp(-std::pow(0.0 - 1 - i, 2) / (2 * variance));
    expected[static_cast<std::size_t>(i + 1)] = (0.1 + 0.9 * f_d) * (0.5 + 0.5 * f_f);
    sum += expected[static_cast<std::size_t>(i + 1)];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(jumps.evidence.x[c](0, 1), expected[c] / sum, 1e-5) << c;
  }
  EXPECT_EQ(jumps.inputs.pixel_counts(0, 1), 0);
  EXPECT_EQ(jumps.inputs.pixel_counts(0, 2), 1);
}

TEST(EvidenceOfPaper, KnowsNoNoiseAndNoSigmaOfOptions) {
  const Frame frame = sloping_row();
  const auto evidence_of = [&](double noise_scale, double sigma_cycles) {
    UnwrapOptions options;
    options.sigma_cycles = sigma_cycles;
    return JumpEstimator()
        .estimate(frame, PhaseSigma(frame, {{.scale = noise_scale}, {.scale = noise_scale}}),
                  {.wavelength_a_m = longer_m, .wavelength_b_m = shorter_m, .count_a = 2},
                  jump_method(UnwrapMethod::paper), options)
        .evidence.x[0](0, 0);
  };
  EXPECT_EQ(evidence_of(0.01, 0.07), evidence_of(1, 0.3));
}

}  // namespace
}  // namespace tofmap
