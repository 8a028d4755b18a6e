// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The claims of Droeschel, Holz and Behnke (IROS 2010), section III, on simulated scenes.

#include <gtest/gtest.h>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

struct Outcome {
  double wrong_percent = 0;
  UnwrapResult result;
};

Outcome unwrap_scene(const char* scene, const char* method, int index = 5) {
  const Simulator simulator(make_scene(scene), {});
  const SimulatedFrame simulated = simulator.simulate(index);
  UnwrapOptions options;
  options.method = method;
  Outcome outcome;
  outcome.result = unwrap(simulated.frame, simulator.sensor(), options);
  const double half_wavelength_m = simulator.sensor().modulation.wavelength_a_m() / 2;
  int wrong = 0;
  int all = 0;
  for (Eigen::Index i = 0; i < simulated.range_truth_m.size(); ++i) {
    const float truth = simulated.range_truth_m.data()[i];
    const float range = outcome.result.image.range_m.data()[i];
    if (!std::isfinite(truth) || !std::isfinite(range)) continue;
    ++all;
    wrong += std::abs(range - truth) > half_wavelength_m ? 1 : 0;
  }
  outcome.wrong_percent = 100.0 * wrong / all;
  return outcome;
}

// Pixels that mix both sides of an edge have no right count: about one in a hundred here.
constexpr double nearly_none_percent = 1.5;

/// "In the two experiments belief propagation converged in less than 5 iterations."
void expect_convergence_as_in_the_paper(const Outcome& outcome) {
  EXPECT_TRUE(outcome.result.converged);
  EXPECT_EQ(outcome.result.curl_violations, 0);
  EXPECT_LT(outcome.result.iterations, 5);
}

TEST(ContinuousWall, IsUnwrappedWithAndWithoutTheSecondFrequency) {
  EXPECT_GT(unwrap_scene("wall", "none").wrong_percent, 20);
  for (const char* method : {"single", "jump"}) {
    const Outcome outcome = unwrap_scene("wall", method);
    EXPECT_LT(outcome.wrong_percent, nearly_none_percent) << method;
    SCOPED_TRACE(method);
    expect_convergence_as_in_the_paper(outcome);
  }
}

TEST(SteepSlopes, NeedTheSecondFrequency) {
  EXPECT_GT(unwrap_scene("slope", "single").wrong_percent, 10);
  for (int frame = 0; frame < 10; ++frame) {
    SCOPED_TRACE(frame);
    const Outcome outcome = unwrap_scene("slope", "jump", frame);
    EXPECT_LT(outcome.wrong_percent, nearly_none_percent);
    expect_convergence_as_in_the_paper(outcome);
  }
}

TEST(SceneBeyondOneWavelength, NeedsTheSecondFrequency) {
  EXPECT_GT(unwrap_scene("beyond", "single").wrong_percent, 50);
  EXPECT_LT(unwrap_scene("beyond", "jump").wrong_percent, nearly_none_percent);
}

TEST(Unwrapping, GivesTheSameBitsEveryTime) {
  const RangeImage first = unwrap_scene("corridor", "jump").result.image;
  const RangeImage second = unwrap_scene("corridor", "jump").result.image;
  EXPECT_TRUE((first.wrap_count == second.wrap_count).all());
  EXPECT_TRUE((first.confidence == second.confidence).all());
}

}  // namespace
}  // namespace tofmap
