// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/libfreenect2_unwrap.hpp"

#include "peers/synthetic_scenes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap::peers {
namespace {

/// A view whose ranges grow from left to right.
SceneView ramp(double from_m, double to_m, float albedo) {
  SceneView view{ImageF(8, 700), ImageF::Constant(8, 700, albedo)};
  for (Eigen::Index u = 0; u < 700; ++u)
    view.range_m.col(u) =
        static_cast<float>(from_m + (to_m - from_m) * static_cast<double>(u) / 699);
  return view;
}

Libfreenect2Options keeping_all() {
  Libfreenect2Options options;
  options.reject_outliers = false;
  options.smooth = false;
  return options;
}

Rejection rejection_of(const Libfreenect2Result& result, Eigen::Index v, Eigen::Index u) {
  return static_cast<Rejection>(result.rejection(v, u));
}

TEST(Libfreenect2Unwrap, IdealPhasesUpTo18MetresGiveTheirRangesAndCounts) {
  const SceneView view = ramp(0.6, 18.2, 0.5F);
  for (const bool reject : {false, true}) {
    Libfreenect2Options options = keeping_all();
    options.reject_outliers = reject;
    const Libfreenect2Result result = libfreenect2_unwrap(measure(view, {}), options);
    EXPECT_LT((result.range_m - view.range_m).abs().maxCoeff(), 1e-3F);
    EXPECT_EQ(result.wrap_count(4, 0), 0);
    EXPECT_EQ(result.wrap_count(4, 699), 9);
    EXPECT_EQ((result.rejection != 0).count(), 0);
  }
}

TEST(Libfreenect2Unwrap, ModerateNoiseGivesFewWrongWraps) {
  const SceneView view = view_of(SyntheticScene::hall, 160, 120);
  NoiseOptions noise;
  noise.sigma_at_10_m_rad = 0.1;
  const Libfreenect2Result result = libfreenect2_unwrap(measure(view, noise), keeping_all());
  const auto wrong = ((result.range_m - view.range_m).abs() > 0.3F).count();
  EXPECT_LT(static_cast<double>(wrong), 0.03 * static_cast<double>(view.range_m.size()));
}

TEST(Libfreenect2Unwrap, WeakPixelsAreRejectedWithTheirReason) {
  ThreePhases phases = measure(ramp(1, 9, 0.5F), {});
  phases.amplitude[1](3, 50) = 2.9F;
  for (std::size_t m = 0; m < 3; ++m) phases.amplitude[m](3, 60) = 3.2F;
  phases.amplitude[2](3, 70) = nan;
  Libfreenect2Options options;
  options.smooth = false;
  options.edge_filter = false;
  const Libfreenect2Result result = libfreenect2_unwrap(phases, options);
  EXPECT_EQ(rejection_of(result, 3, 50), Rejection::weak);
  EXPECT_EQ(rejection_of(result, 3, 60), Rejection::weak);
  EXPECT_EQ(rejection_of(result, 3, 70), Rejection::no_return);
  EXPECT_EQ((result.rejection != 0).count(), 3);
  EXPECT_EQ(result.range_m.isNaN().count(), 3);
  EXPECT_EQ(libfreenect2_unwrap(phases, keeping_all()).range_m.isNaN().count(), 1);
}

TEST(Libfreenect2Unwrap, FrequenciesThatDisagreeAreRejected) {
  ThreePhases phases = measure(ramp(2, 2, 0.5F), {});
  // The shift of 16 MHz alone is in no other direction than that of the range by less than 20°.
  const auto shift = [&](Eigen::Index u, double degrees) {
    const float shifted = phases.phase_cycles[1](3, u) + static_cast<float>(degrees / 360);
    phases.phase_cycles[1](3, u) = shifted - std::floor(shifted);
    for (std::size_t m = 0; m < 3; ++m) phases.amplitude[m](3, u) = 2000;
  };
  shift(50, 15);
  shift(60, 25);
  Libfreenect2Options options;
  options.smooth = false;
  options.edge_filter = false;
  const Libfreenect2Result result = libfreenect2_unwrap(phases, options);
  EXPECT_EQ(rejection_of(result, 3, 50), Rejection::none);
  EXPECT_EQ(rejection_of(result, 3, 60), Rejection::inconsistent);
}

TEST(Libfreenect2Unwrap, FlyingPixelsBetweenTwoSurfacesAreRejected) {
  SceneView view{ImageF::Constant(7, 9, 2), ImageF::Constant(7, 9, 0.5F)};
  view.range_m.rightCols(4).setConstant(3);
  view.range_m.col(5).setConstant(2.4F);
  Libfreenect2Options options;
  options.smooth = false;
  const Libfreenect2Result result = libfreenect2_unwrap(measure(view, {}), options);
  EXPECT_EQ(rejection_of(result, 3, 5), Rejection::edge);
  EXPECT_EQ(rejection_of(result, 0, 5), Rejection::none);  // the outermost rows are not filtered
  EXPECT_EQ((result.rejection != 0).count(), 5);
}

TEST(Libfreenect2Unwrap, OtherFrequenciesAreRefused) {
  ThreePhases phases = measure(ramp(1, 2, 0.5F), {});
  phases.frequencies_hz = {60e6, 20e6, 100e6};
  EXPECT_THROW(libfreenect2_unwrap(phases), UsageError);
}

}  // namespace
}  // namespace tofmap::peers
