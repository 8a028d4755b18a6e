// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/kinect2_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/acquisition/kinect2/companding.hpp>
#include <tofmap/acquisition/kinect2/phases.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr double pi = std::numbers::pi;

/// Difference of two phases in cycles, the shorter way round.
double phase_difference(double a, double b) { return std::remainder(a - b, 1.0); }

/// Images of all frequencies that hold one value.
std::array<ImageF, 3> filled(double value) {
  std::array<ImageF, 3> images;
  for (ImageF& image : images) {
    image.setConstant(image_height_px, image_width_px, static_cast<float>(value));
  }
  return images;
}

TEST(Kinect2Phases, TimesWavelengthIsTheRangeOfTheCamerasModel) {
  const P0Tables p0 = test::sample_p0_tables();
  Measurements measurements = test::sample_measurements();
  std::array<ImageF, 3> range_m = filled(0);
  constexpr double amplitude = 3000;
  for (std::size_t f = 0; f < 3; ++f) {
    const double wavelength_m = 299792458.0 / (2 * frequencies_hz[f]);
    for (Eigen::Index i = 0; i < range_m[f].size(); ++i) {
      const double range = wavelength_m * static_cast<double>(i) / range_m[f].size();
      range_m[f].data()[i] = static_cast<float>(range);
      const double offset = -pi * 0.000031 * p0.tables[f].data()[i];
      for (int k = 0; k < 3; ++k) {
        measurements.steps[f][k].data()[i] = static_cast<std::int16_t>(std::lround(
            amplitude * std::cos(2 * pi * range / wavelength_m + offset + 2 * pi * k / 3)));
      }
    }
  }
  const Phases phases = phases_from_measurements(measurements, p0);
  for (std::size_t f = 0; f < 3; ++f) {
    const double wavelength_m = 299792458.0 / (2 * frequencies_hz[f]);
    double worst_cycles = 0;
    for (Eigen::Index i = 0; i < range_m[f].size(); ++i) {
      const double phase = phases.phase[f].data()[i];
      ASSERT_TRUE(phase >= 0 && phase < 1);
      const double error = phase_difference(phase, range_m[f].data()[i] / wavelength_m);
      worst_cycles = std::max(worst_cycles, std::abs(error));
    }
    EXPECT_LT(worst_cycles, 1e-4);  // half a unit of rounding in 3000
    const ImageF expected = filled(amplitude * amplitude_factors[f])[0];
    EXPECT_LT((phases.amplitude[f] - expected).abs().maxCoeff(), 1.7);
    EXPECT_EQ(phases.saturated[f].cast<int>().sum(), 0);
  }
}

TEST(Kinect2Phases, EqualTheFormulaWithTheSinesAndCosinesOfEveryStep) {
  const P0Tables p0 = test::sample_p0_tables();
  const Measurements measurements = test::sample_measurements();
  const Phases phases = phases_from_measurements(measurements, p0);
  for (std::size_t f = 0; f < 3; ++f) {
    for (Eigen::Index i = 0; i < image_width_px * image_height_px; i += 7) {
      const double offset = -pi * 0.000031 * p0.tables[f].data()[i];
      double in_phase = 0;
      double quadrature = 0;
      for (int k = 0; k < 3; ++k) {
        const double m = measurements.steps[f][k].data()[i];
        in_phase += m * std::cos(offset + 2 * pi * k / 3);
        quadrature -= m * std::sin(offset + 2 * pi * k / 3);
      }
      const double amplitude = amplitude_factors[f] * 2 / 3 * std::hypot(in_phase, quadrature);
      ASSERT_NEAR(phases.amplitude[f].data()[i], amplitude, 1e-6 * amplitude + 1e-3);
      if (amplitude < 0.1) continue;
      const double cycles = std::atan2(quadrature, in_phase) / (2 * pi);
      ASSERT_NEAR(phase_difference(phases.phase[f].data()[i], cycles), 0, 1e-6);
    }
  }
}

TEST(Kinect2Phases, ArriveThroughAPacketToWithinTheStepOfItsCodes) {
  const P0Tables p0 = test::sample_p0_tables();
  std::array<ImageF, 3> phase = filled(0);
  std::array<ImageF, 3> amplitude = filled(0);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> cycles(0, 1);
  std::uniform_real_distribution<float> decades(1.5F, 4);
  for (std::size_t f = 0; f < 3; ++f) {
    for (Eigen::Index i = 0; i < phase[f].size(); ++i) {
      phase[f].data()[i] = cycles(random);
      amplitude[f].data()[i] = std::pow(10.0F, decades(random));
    }
  }
  const Measurements measurements = measurements_from_phases(phase, amplitude, p0);
  const Phases phases = phases_from_measurements(decode_packet(encode_packet(measurements)), p0);
  for (std::size_t f = 0; f < 3; ++f) {
    for (int v = 0; v < image_height_px; ++v) {
      for (int u = 1; u < 511; ++u) {
        // Rounding errors of the steps: half a unit, and then half of at most 1/128 of the step.
        const double a = amplitude[f](v, u);
        const double unit = amplitude_factors[f] * (0.5 + a / amplitude_factors[f] / 256) * 4 / 3;
        ASSERT_NEAR(phases.amplitude[f](v, u), a, unit);
        ASSERT_NEAR(phase_difference(phases.phase[f](v, u), phase[f](v, u)), 0,
                    std::asin(std::min(1.0, unit / a)) / (2 * pi));
      }
    }
    EXPECT_EQ(phases.saturated[f].cast<int>().sum(), 0);
  }
}

TEST(Kinect2Phases, OfPixelsWithoutSignalAreNan) {
  Measurements measurements = test::sample_measurements();
  for (Image<std::int16_t>& step : measurements.steps[1]) step(3, 4) = 17;  // a constant alone
  const Phases phases = phases_from_measurements(measurements, test::sample_p0_tables());
  EXPECT_TRUE(std::isnan(phases.phase[1](3, 4)));
  EXPECT_EQ(phases.amplitude[1](3, 4), 0);
  EXPECT_EQ(phases.saturated[1](3, 4), 0);
  for (const ImageF& phase : phases.phase) {
    EXPECT_TRUE(phase.col(0).isNaN().all());
    EXPECT_TRUE(phase.col(511).isNaN().all());
  }
}

TEST(Kinect2Phases, OfAPixelWithOneSaturatedStepAreSaturatedAtThatFrequencyAlone) {
  for (int k = 0; k < 3; ++k) {
    Measurements measurements = test::sample_measurements();
    measurements.steps[2][k](100, 200) = saturated_measurement;
    const Phases phases = phases_from_measurements(measurements, test::sample_p0_tables());
    EXPECT_TRUE(std::isnan(phases.phase[2](100, 200)));
    EXPECT_EQ(phases.amplitude[2](100, 200), saturated_amplitude);
    EXPECT_EQ(phases.saturated[2](100, 200), 1);
    EXPECT_EQ(phases.saturated[2].cast<int>().sum(), 1);
    EXPECT_EQ(phases.saturated[0].cast<int>().sum(), 0);
    EXPECT_FALSE(std::isnan(phases.phase[0](100, 200)));
  }
}

TEST(Kinect2Phases, OfTheLargestMeasurementsAreBelowTheAmplitudeOfSaturation) {
  Measurements measurements = test::sample_measurements();
  for (Steps& steps : measurements.steps) {
    steps[0].setConstant(largest_magnitude);
    steps[1].setConstant(-largest_magnitude);
    steps[2].setConstant(-largest_magnitude);
  }
  const Phases phases = phases_from_measurements(measurements, test::sample_p0_tables());
  EXPECT_LT(phases.amplitude[2].maxCoeff(), 35100);
}

TEST(Kinect2Phases, ThatAreUnknownOrTooBrightMeasureNothingOrSaturation) {
  std::array<ImageF, 3> phase = filled(0.25);
  std::array<ImageF, 3> amplitude = filled(100);
  phase[0](0, 1) = nan;
  amplitude[0](0, 2) = nan;
  amplitude[0](0, 3) = 0;
  amplitude[0](0, 4) = -5;
  amplitude[0](0, 5) = saturated_amplitude;
  amplitude[0](0, 6) = std::numeric_limits<float>::infinity();
  phase[0](0, 7) = 0;
  amplitude[0](0, 7) = 30000;
  P0Tables p0 = test::sample_p0_tables();
  p0.tables[0].setZero();
  const Measurements measurements = measurements_from_phases(phase, amplitude, p0);
  for (const Image<std::int16_t>& step : measurements.steps[0]) {
    for (const int u : {1, 2, 3, 4}) EXPECT_EQ(step(0, u), 0) << u;
    for (const int u : {5, 6}) EXPECT_EQ(step(0, u), saturated_measurement) << u;
  }
  EXPECT_EQ(measurements.steps[0][0](0, 7), saturated_measurement) << "22 683 is off the scale";
  EXPECT_EQ(measurements.steps[0][1](0, 7), -11341);
}

TEST(Kinect2Phases, OfImagesOfAnotherSizeAreWrongUse) {
  const P0Tables p0 = test::sample_p0_tables();
  EXPECT_THROW(phases_from_measurements(Measurements{}, p0), UsageError);
  EXPECT_THROW(phases_from_measurements(test::sample_measurements(), P0Tables{}), UsageError);
  EXPECT_THROW(measurements_from_phases(filled(0), std::array<ImageF, 3>{}, p0), UsageError);
}

}  // namespace
}  // namespace tofmap::kinect2
