// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/kde_unwrap.hpp"

#include "peers/kde_oracle.hpp"
#include "peers/synthetic_scenes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap::peers {
namespace {

KdeOptions with_hypotheses(int hypotheses) {
  KdeOptions options;
  options.hypotheses = hypotheses;
  options.min_confidence = 0;
  options.smooth = false;
  return options;
}

/// A view whose ranges grow from left to right.
SceneView ramp(double from_m, double to_m) {
  SceneView view{ImageF(8, 700), ImageF::Constant(8, 700, 0.5F)};
  for (Eigen::Index u = 0; u < 700; ++u)
    view.range_m.col(u) =
        static_cast<float>(from_m + (to_m - from_m) * static_cast<double>(u) / 699);
  return view;
}

double wrong_percent(const ImageF& range_m, const ImageF& truth_m) {
  return 100.0 * static_cast<double>(((range_m - truth_m).abs() > 0.3F).count()) /
         static_cast<double>(truth_m.size());
}

class KdeUnwrap : public testing::TestWithParam<int> {};

TEST_P(KdeUnwrap, IdealPhasesUpTo18MetresGiveTheirRangesAndCounts) {
  const SceneView view = ramp(0.6, 18.2);
  const KdeResult result = kde_unwrap(measure(view, {}), with_hypotheses(GetParam()));
  EXPECT_LT((result.range_m - view.range_m).abs().maxCoeff(), 1e-3F);
  constexpr float wavelength_m = 299792458.0F / 160e6F;
  for (Eigen::Index u = 0; u < 700; ++u) {
    const float cycles = view.range_m(4, u) / wavelength_m;
    if (std::abs(cycles - std::round(cycles)) < 1e-3F) continue;
    EXPECT_EQ(result.wrap_count(4, u), static_cast<int>(cycles));
  }
}

TEST_P(KdeUnwrap, AgreesWithItsEquations) {
  const SceneView view = view_of(SyntheticScene::hall, 45, 37);
  NoiseOptions noise;
  noise.sigma_at_10_m_rad = 0.5;
  ThreePhases phases = measure(view, noise);
  phases.phase_cycles[1](17, 20) = nan;
  phases.amplitude[2](20, 40) = nan;
  phases.amplitude[0](3, 3) = 3e4F;  // saturated
  for (const Fusion fusion : {Fusion::mean_phase, Fusion::inverse_variance}) {
    KdeOptions options = with_hypotheses(GetParam());
    options.fusion = fusion;
    const KdeResult fast = kde_unwrap(phases, options);
    const KdeResult slow = kde_by_equations(phases, options);
    EXPECT_LT((fast.confidence - slow.confidence).abs().maxCoeff(), 1e-4F);
    int others = 0;
    for (Eigen::Index i = 0; i < fast.range_m.size(); ++i) {
      EXPECT_EQ(std::isnan(fast.range_m.data()[i]), std::isnan(slow.range_m.data()[i])) << i;
      if (std::abs(fast.range_m.data()[i] - slow.range_m.data()[i]) > 1e-3F ||
          fast.wrap_count.data()[i] != slow.wrap_count.data()[i])
        ++others;
    }
    EXPECT_LE(others, 1);  // two hypotheses may be as dense but for rounding
  }
}

TEST_P(KdeUnwrap, ModerateNoiseGivesFewWrongWraps) {
  const SceneView view = view_of(SyntheticScene::hall, 160, 120);
  NoiseOptions noise;
  noise.sigma_at_10_m_rad = 0.1;
  const KdeResult result = kde_unwrap(measure(view, noise), with_hypotheses(GetParam()));
  EXPECT_LT(wrong_percent(result.range_m, view.range_m), 1.5);
}

TEST_P(KdeUnwrap, PixelsWithoutAReturnHaveNoRangeAndDisturbNoOther) {
  const SceneView view = ramp(0.6, 18.2);
  ThreePhases phases = measure(view, {});
  phases.phase_cycles[2](3, 100) = nan;
  phases.amplitude[1](5, 400) = nan;
  const KdeResult result = kde_unwrap(phases, with_hypotheses(GetParam()));
  EXPECT_TRUE(std::isnan(result.range_m(3, 100)));
  EXPECT_TRUE(std::isnan(result.range_m(5, 400)));
  EXPECT_EQ(result.confidence(3, 100), 0);
  EXPECT_EQ(result.wrap_count(5, 400), no_wrap_count);
  EXPECT_EQ(result.range_m.isNaN().count(), 2);
}

TEST_P(KdeUnwrap, FewOfThePixelsThatAreKeptAreWrong) {
  const SceneView view = view_of(SyntheticScene::hall, 160, 120);
  NoiseOptions noise;
  noise.sigma_at_10_m_rad = 0.8;
  const ThreePhases phases = measure(view, noise);
  KdeOptions options = with_hypotheses(GetParam());
  const double all = wrong_percent(kde_unwrap(phases, options).range_m, view.range_m);
  options.min_confidence = 0.5;
  const ImageF kept_m = kde_unwrap(phases, options).range_m;
  EXPECT_GT(all, 2);
  EXPECT_LT(wrong_percent(kept_m, view.range_m), all / 5);
  EXPECT_GT(kept_m.isNaN().count(), 0);
}

INSTANTIATE_TEST_SUITE_P(Hypotheses, KdeUnwrap, testing::Values(2, 3));

TEST(KdeOptions, ThreeHypothesesAreNoWorseThanTwo) {
  for (const SyntheticScene scene : all_synthetic_scenes) {
    const SceneView view = view_of(scene, 160, 120);
    NoiseOptions noise;
    noise.sigma_at_10_m_rad = 0.6;
    const ThreePhases phases = measure(view, noise);
    const ImageF two_m = kde_unwrap(phases, with_hypotheses(2)).range_m;
    const ImageF three_m = kde_unwrap(phases, with_hypotheses(3)).range_m;
    EXPECT_LE(wrong_percent(three_m, view.range_m), wrong_percent(two_m, view.range_m) + 0.02)
        << name_of(scene);
  }
}

TEST(KdeOptions, PhaseBiasesAreSubtracted) {
  const SceneView view = ramp(0.6, 18.2);
  KdeOptions options = with_hypotheses(2);
  options.camera.phase_bias_cycles = {0.3, -0.2, 1.4};
  ThreePhases phases = measure(view, {});
  for (std::size_t m = 0; m < 3; ++m) {
    const ImageF shifted =
        phases.phase_cycles[m] + static_cast<float>(options.camera.phase_bias_cycles[m]);
    phases.phase_cycles[m] = shifted - shifted.floor();
  }
  EXPECT_LT((kde_unwrap(phases, options).range_m - view.range_m).abs().maxCoeff(), 1e-3F);
}

TEST(KdeOptions, WhatIsNotAllowedIsRefused) {
  const ThreePhases phases = measure(ramp(1, 2), {});
  EXPECT_THROW(kde_unwrap(phases, with_hypotheses(4)), UsageError);
  KdeOptions options;
  options.kernel_bandwidth_m = 0;
  EXPECT_THROW(kde_unwrap(phases, options), UsageError);
  ThreePhases cut = phases;
  cut.amplitude[1].resize(3, 3);
  EXPECT_THROW(kde_unwrap(cut, {}), UsageError);
}

}  // namespace
}  // namespace tofmap::peers
