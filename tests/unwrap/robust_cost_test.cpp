// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/robust_cost.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/image.hpp>

namespace tofmap {
namespace {

/// Equation 20 of docs/unwrapping.md.
double cost(double error_m, double variance_m2) {
  const double square = error_m * error_m / variance_m2;
  return 0.5 * square / (1 + square / 9);
}

TEST(RobustCost, IsTheSumOverAllSamplesWhereAnUnseenOneCostsTheMean) {
  const std::vector<float> errors_m{0.05F, 0.01F, nan, -0.2F};
  const std::vector<float> variances_m2{4e-4F, 1e-4F, 1e-4F, 9e-4F};
  constexpr double systematic_m = 0.01;
  const double seen = cost(0.05, 5e-4) + cost(0.01, 2e-4) + cost(0.2, 1e-3);
  EXPECT_NEAR(robust_cost(errors_m, variances_m2, systematic_m), 4 * seen / 3, 1e-5);
}

TEST(RobustCost, IsInfiniteIfNoSampleWasSeen) {
  EXPECT_TRUE(std::isinf(robust_cost({nan, nan}, {1, 1}, 0)));
}

TEST(RobustWeights, AreTheSlopeOfTheCostOverTheErrorAndNoneForAnUnseenSample) {
  const std::vector<float> errors_m{0.05F, 0.001F, nan};
  const std::vector<float> variances_m2{4e-4F, 1e-4F, 1e-4F};
  std::vector<float> weights(3, -1);
  fill_robust_weights(errors_m, variances_m2, 0.01, weights);
  constexpr double step = 1e-6;
  for (std::size_t i = 0; i < 2; ++i) {
    const double variance = variances_m2[i] + 1e-4;
    const double slope =
        (cost(errors_m[i] + step, variance) - cost(errors_m[i] - step, variance)) / (2 * step);
    EXPECT_NEAR(weights[i], slope / errors_m[i], 1e-4 * weights[i]);
  }
  EXPECT_EQ(weights[2], 0);
}

}  // namespace
}  // namespace tofmap
