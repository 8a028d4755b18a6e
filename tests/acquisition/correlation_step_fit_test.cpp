// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/correlation_arrays.hpp>

#include <tofmap/acquisition/correlation/step_fit.hpp>

namespace tofmap {
namespace {

std::vector<double> radians(std::vector<double> angles_deg) {
  for (double& angle : angles_deg) angle *= std::numbers::pi / 180;
  return angles_deg;
}

std::vector<double> evenly_spaced(int steps) {
  std::vector<double> angles;
  for (int k = 0; k < steps; ++k) angles.push_back(2 * std::numbers::pi * k / steps);
  return angles;
}

/// Angles that occur: three to eight steps, evenly spaced or not, in any order and direction.
const std::vector<std::vector<double>> usual_angles = {
    evenly_spaced(3),           evenly_spaced(4),
    evenly_spaced(5),           evenly_spaced(8),
    radians({0, 100, 230}),     radians({0, -90, -180, -270}),
    radians({0, 180, 90, 270}), radians({10, 77, 200, 201, 350})};

/// Images of one row with a pixel for each of many phases.
struct Row {
  std::vector<double> phases;
  std::vector<ImageF> steps;
};

Row row_of_phases(const std::vector<double>& angles_rad, int sign, double offset) {
  Row row;
  for (int i = 0; i < 400; ++i) row.phases.push_back(i / 400.0);
  for (const double angle : angles_rad) {
    ImageF step(1, 400);
    for (int i = 0; i < 400; ++i) {
      const double cycles = row.phases[static_cast<std::size_t>(i)];
      step(0, i) =
          static_cast<float>(offset + 300 * std::cos(2 * std::numbers::pi * sign * cycles - angle));
    }
    row.steps.push_back(step);
  }
  return row;
}

TEST(StepFit, FindsThePhasesThatTheImagesWereMadeOf) {
  for (const std::vector<double>& angles : usual_angles) {
    for (const int sign : {1, -1}) {
      for (const bool with_offset : {true, false}) {
        const Row row = row_of_phases(angles, sign, with_offset ? 1000 : 0);
        const StepFit fit = fit_steps(row.steps, StepDesign(angles, with_offset, sign));
        for (int i = 0; i < 400; ++i) {
          const double wanted = row.phases[static_cast<std::size_t>(i)];
          EXPECT_LT(test::phase_difference(fit.phase(0, i), wanted), 3e-6) << angles.size();
          EXPECT_GE(fit.phase(0, i), 0);
          EXPECT_LT(fit.phase(0, i), 1);
          EXPECT_NEAR(fit.amplitude(0, i), 300, 0.005);
          EXPECT_NEAR(fit.offset(0, i), with_offset ? 1000 : 0, 0.005);
        }
        EXPECT_TRUE((fit.squared_residual < 1e-4F).all());
      }
    }
  }
}

TEST(StepFit, OfFourRightAnglesIsTheArctangentOfDifferences) {
  const StepDesign design(radians({0, 90, 180, 270}), true);
  std::vector<ImageF> steps;
  for (const float value : {700.0F, 310.0F, 420.0F, 555.0F})
    steps.push_back(ImageF::Constant(1, 1, value));
  const StepFit fit = fit_steps(steps, design);
  const double cycles = std::atan2(310.0 - 555, 700.0 - 420) / (2 * std::numbers::pi);
  EXPECT_NEAR(fit.phase(0, 0), cycles + 1, 1e-6);
  EXPECT_NEAR(fit.amplitude(0, 0), std::hypot(310.0 - 555, 700.0 - 420) / 2, 1e-3);
}

/// Sum of squared differences between values and model.
double misfit(const std::vector<ImageF>& steps, const std::vector<double>& angles, double b,
              double a, double cycles) {
  double sum = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double off = steps[k](0, 0) - b - a * std::cos(2 * std::numbers::pi * cycles - angles[k]);
    sum += off * off;
  }
  return sum;
}

TEST(StepFit, HasTheLeastSquaresOfASearch) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 30);
  for (const std::vector<double>& angles : usual_angles) {
    if (angles.size() < 4) continue;
    std::vector<ImageF> steps;
    for (const double angle : angles) {
      steps.push_back(ImageF::Constant(
          1, 1, 500 + 100 * static_cast<float>(std::cos(1.1 - angle)) + noise(random)));
    }
    const StepFit fit = fit_steps(steps, StepDesign(angles, true));
    const double found = fit.squared_residual(0, 0);
    EXPECT_NEAR(misfit(steps, angles, fit.offset(0, 0), fit.amplitude(0, 0), fit.phase(0, 0)),
                found, 0.01 + 1e-3 * found);
    // No phase of a fine grid, with the offset and amplitude of a grid around it, fits better.
    for (int i = 0; i < 200; ++i) {
      for (int j = -20; j <= 20; ++j) {
        for (int k = -20; k <= 20; ++k) {
          EXPECT_GE(misfit(steps, angles, fit.offset(0, 0) + j, fit.amplitude(0, 0) + k, i / 200.0),
                    found * (1 - 1e-4) - 0.01);
        }
      }
    }
  }
}

TEST(StepFit, OfThreeStepsLeavesNoResidual) {
  const StepDesign design(evenly_spaced(3), true);
  EXPECT_EQ(design.degrees_of_freedom(), 0);
  EXPECT_EQ(fit_steps(std::vector<ImageF>(3, ImageF::Ones(2, 2)), design).squared_residual.size(),
            0);
  EXPECT_EQ(StepDesign(evenly_spaced(8), true).degrees_of_freedom(), 5);
  EXPECT_EQ(StepDesign(radians({0, 90}), false).degrees_of_freedom(), 0);
}

TEST(StepFit, WithoutSignalHasNoPhase) {
  const StepDesign design(evenly_spaced(4), true);
  std::vector<ImageF> steps(4, ImageF::Constant(1, 3, 1234.5F));
  steps[2](0, 1) = nan;
  steps[2](0, 2) = std::numeric_limits<float>::infinity();
  const StepFit fit = fit_steps(steps, design);
  EXPECT_EQ(fit.amplitude(0, 0), 0);
  EXPECT_TRUE(std::isnan(fit.amplitude(0, 1)));
  EXPECT_TRUE(std::isnan(fit.amplitude(0, 2)));
  EXPECT_TRUE(fit.phase.isNaN().all());
}

TEST(StepDesign, KnowsHowWellItsAnglesDetermineThePhase) {
  for (const int steps : {3, 4, 5, 8}) {
    EXPECT_NEAR(StepDesign(evenly_spaced(steps), true).condition_number(), std::numbers::sqrt2,
                1e-9);
    EXPECT_NEAR(StepDesign(evenly_spaced(steps), false).condition_number(), 1, 1e-9);
  }
  EXPECT_GT(StepDesign(radians({0, 60, 120}), true).condition_number(), 5);
}

TEST(StepDesign, OfAnglesThatDoNotSpanTheCircleIsRefusedWithThem) {
  const auto complaint = [](const std::vector<double>& angles_deg, bool with_offset) {
    return test::input_error([&] { StepDesign(radians(angles_deg), with_offset); });
  };
  EXPECT_THAT(complaint({0, 20, 40}, true), testing::HasSubstr("0, 20, 40 degrees"));
  EXPECT_THAT(complaint({0, 20, 40}, true),
              testing::HasSubstr("condition number of their fit is 67.6"));
  EXPECT_THAT(complaint({0, 180, 360, 540}, true), testing::HasSubstr("condition number"));
  EXPECT_THAT(complaint({90, 90, 90}, true), testing::HasSubstr("condition number"));
  EXPECT_THAT(complaint({0, 90}, true), testing::HasSubstr("at least 3 steps"));
  EXPECT_THAT(complaint({0, 180}, false), testing::HasSubstr("condition number"));
  EXPECT_THAT(complaint({0}, false), testing::HasSubstr("at least 2 steps"));
  EXPECT_EQ(complaint({0, 90}, false), "");
}

TEST(StepFit, OfTheWrongNumberOrSizeOfImagesIsWrongUse) {
  const StepDesign design(evenly_spaced(4), true);
  EXPECT_THROW(fit_steps(std::vector<ImageF>(3, ImageF::Ones(1, 1)), design), UsageError);
  std::vector<ImageF> steps(4, ImageF::Ones(1, 1));
  steps[3] = ImageF::Ones(1, 2);
  EXPECT_THROW(fit_steps(steps, design), UsageError);
  EXPECT_THROW(StepDesign(evenly_spaced(4), true, 2), UsageError);
}

}  // namespace
}  // namespace tofmap
