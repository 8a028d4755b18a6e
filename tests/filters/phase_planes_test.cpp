// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plain_phase_planes.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr int rows = 20;
constexpr int cols = 24;
constexpr int margin = 8;

float wrapped(double cycles) { return static_cast<float>(cycles - std::floor(cycles)); }

/// Wavelengths of A over those of each frequency: of two frequencies that are alike, and of three
/// such as those of a Kinect v2.
const std::vector<float> two_ratios{1, 1.2F};
const std::vector<float> three_ratios{1, 0.2F, 1.5F};

/// Two planes in phase that meet in a step, with noise and holes.
Phasors noisy_phasors(const std::vector<float>& ratios, double sigma_cycles, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma_cycles);
  std::vector<ImageF> phases(ratios.size(), ImageF(rows, cols));
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const double cycles = 1.3 + 0.01 * u - 0.006 * v + (u > 13 ? 0.3 : 0);
      for (std::size_t f = 0; f < ratios.size(); ++f) {
        phases[f](v, u) = wrapped(ratios[f] * cycles + noise(random));
      }
    }
  }
  phases.front()(5, 5) = std::numeric_limits<float>::quiet_NaN();
  phases.back()(9, 14) = std::numeric_limits<float>::quiet_NaN();
  return {phases, ImageF::Constant(rows, cols, static_cast<float>(sigma_cycles)), margin};
}

std::complex<double> value(const PhasorImage& image, int v, int u) {
  return {image.re.row(v)[u], image.im.row(v)[u]};
}

TEST(PhasePlanes, AgreeWithAPlainSumOverEachWindow) {
  for (const auto& ratios : {two_ratios, three_ratios}) {
    const WindowGrowth growth{
        .wavelength_ratios = ratios, .last_radius_px = 7, .first_radius_px = 3.5, .growth = 2};
    const Phasors phasors = noisy_phasors(ratios, 0.2, 1);
    const PhasePlanes planes = grow_phase_planes(phasors, rows, cols, growth);
    test::PlainPhasePlanes plain(phasors, rows, cols, growth);
    plain.grow(3.5, true);
    plain.grow(7, false);
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        const test::PlainPhasePlane& expected = plain.at(v, u);
        // Floats, summed over some hundred pixels, and rotors turned from pixel to pixel.
        for (std::size_t f = 0; f < ratios.size(); ++f) {
          EXPECT_LT(std::abs(value(planes.phases[f], v, u) - expected.phases[f]), 1e-3);
        }
        EXPECT_NEAR(planes.slope_x.row(v)[u], expected.slope.x(), 1e-3);
        EXPECT_NEAR(planes.slope_y.row(v)[u], expected.slope.y(), 1e-3);
        EXPECT_NEAR(planes.variance.row(v)[u] / expected.variance, 1, 1e-2);
        EXPECT_NEAR(planes.slope_variance.row(v)[u] / expected.slope_variance, 1, 1e-2);
        EXPECT_NEAR(planes.lever_variance.row(v)[u], expected.lever_variance,
                    1e-2 * expected.variance);
      }
    }
  }
}

TEST(PhasePlanes, FindThePhasesAndSlopesOfAPlane) {
  const double sigma_cycles = 0.02;
  const PhasePlanes planes =
      grow_phase_planes(noisy_phasors(two_ratios, sigma_cycles, 2), rows, cols,
                        {.wavelength_ratios = two_ratios, .last_radius_px = 6});
  const double expected = two_pi * (1.3 + 0.01 * 5 - 0.006 * 10);
  const double phase = std::arg(value(planes.phases[0], 10, 5));
  // Five standard deviations of a mean over at least 30 pixels.
  EXPECT_NEAR(std::remainder(phase - expected, two_pi), 0,
              5 * two_pi * sigma_cycles / std::sqrt(30));
  EXPECT_NEAR(planes.slope_x.row(10)[5], two_pi * 0.01, 0.02);
  EXPECT_NEAR(planes.slope_y.row(10)[5], -two_pi * 0.006, 0.02);
}

TEST(PhasePlanes, DoNotChangeWithTheOriginOfPhases) {
  const WindowGrowth growth{.wavelength_ratios = two_ratios, .last_radius_px = 7};
  const Phasors phasors = noisy_phasors(two_ratios, 0.2, 3);
  Phasors turned = phasors;
  const std::complex<double> turn = std::polar(1.0, 2.0);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const std::complex<double> z = value(phasors.frequencies[0], v, u) * turn;
      turned.frequencies[0].re.row(v)[u] = static_cast<float>(z.real());
      turned.frequencies[0].im.row(v)[u] = static_cast<float>(z.imag());
    }
  }
  const PhasePlanes planes = grow_phase_planes(phasors, rows, cols, growth);
  const PhasePlanes moved = grow_phase_planes(turned, rows, cols, growth);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const std::complex<double> z = value(planes.phases[0], v, u);
      EXPECT_LT(std::abs(z * turn - value(moved.phases[0], v, u)), 1e-3);
    }
  }
}

TEST(PhasePlanes, TakeInformationFromNoiseAsSumsOfPhasorsUseIt) {
  // Where noise is small a phase holds 1 / σ².
  EXPECT_NEAR(phase_information(0.02F) * std::pow(two_pi * 0.02, 2), 1, 0.02);
  // The scatter of the phase of a sum of 400 unit phasors, 2000 times: its variance to 10 %.
  constexpr double sigma_rad = 1.4;
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0, sigma_rad);
  double squares = 0;
  constexpr int sums = 2000;
  constexpr int pixels = 400;
  for (int i = 0; i < sums; ++i) {
    std::complex<double> sum = 0;
    for (int k = 0; k < pixels; ++k) sum += std::polar(1.0, noise(random));
    squares += std::arg(sum) * std::arg(sum) / sums;
  }
  EXPECT_NEAR(squares * pixels * phase_information(sigma_rad / two_pi), 1, 0.1);
}

}  // namespace
}  // namespace tofmap
