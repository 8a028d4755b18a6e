// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plain_phase_planes.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double ratio = 1.2;
constexpr int rows = 20;
constexpr int cols = 24;
constexpr int margin = 8;

float wrapped(double cycles) { return static_cast<float>(cycles - std::floor(cycles)); }

/// Two planes in phase that meet in a step, with noise and holes.
Phasors noisy_phasors(double sigma_cycles, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma_cycles);
  ImageF a(rows, cols);
  ImageF b(rows, cols);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const double cycles = 1.3 + 0.01 * u - 0.006 * v + (u > 13 ? 0.3 : 0);
      a(v, u) = wrapped(cycles + noise(random));
      b(v, u) = wrapped(ratio * cycles + noise(random));
    }
  }
  a(5, 5) = std::numeric_limits<float>::quiet_NaN();
  b(9, 14) = std::numeric_limits<float>::quiet_NaN();
  return {a, b, ImageF::Constant(rows, cols, static_cast<float>(sigma_cycles)), margin};
}

TEST(PhasePlanes, AgreeWithAPlainSumOverEachWindow) {
  const WindowGrowth growth{
      .wavelength_ratio = ratio, .last_radius_px = 7, .first_radius_px = 3.5, .growth = 2};
  const Phasors phasors = noisy_phasors(0.2, 1);
  const PhasePlanes planes = grow_phase_planes(phasors, rows, cols, growth);
  test::PlainPhasePlanes plain(phasors, rows, cols, growth);
  plain.grow(3.5, true);
  plain.grow(7, false);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const test::PlainPhasePlane& expected = plain.at(v, u);
      const std::complex<double> a(planes.a.re.row(v)[u], planes.a.im.row(v)[u]);
      const std::complex<double> b(planes.b.re.row(v)[u], planes.b.im.row(v)[u]);
      // Floats, summed over some hundred pixels, and rotors turned from pixel to pixel.
      EXPECT_LT(std::abs(a - expected.a), 1e-3);
      EXPECT_LT(std::abs(b - expected.b), 1e-3);
      EXPECT_NEAR(planes.slope_x.row(v)[u], expected.slope.x(), 1e-3);
      EXPECT_NEAR(planes.slope_y.row(v)[u], expected.slope.y(), 1e-3);
      EXPECT_NEAR(planes.variance.row(v)[u] / expected.variance, 1, 1e-2);
      EXPECT_NEAR(planes.slope_variance.row(v)[u] / expected.slope_variance, 1, 1e-2);
      EXPECT_NEAR(planes.lever_variance.row(v)[u], expected.lever_variance,
                  1e-2 * expected.variance);
    }
  }
}

TEST(PhasePlanes, FindThePhasesAndSlopesOfAPlane) {
  const double sigma_cycles = 0.02;
  const PhasePlanes planes = grow_phase_planes(noisy_phasors(sigma_cycles, 2), rows, cols,
                                               {.wavelength_ratio = ratio, .last_radius_px = 6});
  const double expected = two_pi * (1.3 + 0.01 * 5 - 0.006 * 10);
  const double phase = std::atan2(planes.a.im.row(10)[5], planes.a.re.row(10)[5]);
  // Five standard deviations of a mean over at least 30 pixels.
  EXPECT_NEAR(std::remainder(phase - expected, two_pi), 0,
              5 * two_pi * sigma_cycles / std::sqrt(30));
  EXPECT_NEAR(planes.slope_x.row(10)[5], two_pi * 0.01, 0.02);
  EXPECT_NEAR(planes.slope_y.row(10)[5], -two_pi * 0.006, 0.02);
}

TEST(PhasePlanes, DoNotChangeWithTheOriginOfPhases) {
  const WindowGrowth growth{.wavelength_ratio = ratio, .last_radius_px = 7};
  const Phasors phasors = noisy_phasors(0.2, 3);
  Phasors turned = phasors;
  const std::complex<float> turn = std::polar(1.0F, 2.0F);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const std::complex<float> z(phasors.a.re.row(v)[u], phasors.a.im.row(v)[u]);
      turned.a.re.row(v)[u] = (z * turn).real();
      turned.a.im.row(v)[u] = (z * turn).imag();
    }
  }
  const PhasePlanes planes = grow_phase_planes(phasors, rows, cols, growth);
  const PhasePlanes moved = grow_phase_planes(turned, rows, cols, growth);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const std::complex<float> z(planes.a.re.row(v)[u], planes.a.im.row(v)[u]);
      const std::complex<float> w(moved.a.re.row(v)[u], moved.a.im.row(v)[u]);
      EXPECT_LT(std::abs(z * turn - w), 1e-3F);
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
