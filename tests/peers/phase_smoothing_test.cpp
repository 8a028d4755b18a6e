// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/phase_smoothing.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace tofmap::peers {
namespace {

constexpr double turn = 2 * std::numbers::pi;

ThreePhases random_phases(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> phase(0, 1);
  std::uniform_real_distribution<float> amplitude(0.5F, 12);
  ThreePhases out;
  for (std::size_t m = 0; m < 3; ++m) {
    out.phase_cycles[m].resize(11, 21);
    out.amplitude[m].resize(11, 21);
    for (Eigen::Index i = 0; i < out.phase_cycles[m].size(); ++i) {
      const bool valid = i % 13 != 0;
      out.phase_cycles[m].data()[i] = valid ? phase(random) : nan;
      out.amplitude[m].data()[i] = valid ? amplitude(random) : nan;
    }
  }
  return out;
}

std::complex<double> phasor(const ThreePhases& phases, std::size_t m, Eigen::Index v,
                            Eigen::Index u) {
  return std::polar<double>(phases.amplitude[m](v, u), turn * phases.phase_cycles[m](v, u));
}

TEST(PhaseSmoothing, AgreesWithItsEquationInEveryPixel) {
  const ThreePhases phases = random_phases(3);
  const SmoothingOptions options;
  const SmoothedPhases smoothed = smooth_phases(phases, options);
  for (Eigen::Index v = 1; v < 10; ++v) {
    for (Eigen::Index u = 1; u < 20; ++u) {
      bool on_edge = false;
      for (std::size_t m = 0; m < 3; ++m) {
        const std::complex<double> own = phasor(phases, m, v, u);
        if (std::isnan(own.real())) {
          EXPECT_TRUE(std::isnan(smoothed.phases.phase_cycles[m](v, u)));
          continue;
        }
        const bool strong = std::abs(own) >= options.min_amplitude;
        std::complex<double> sum = 0;
        double weights = 0;
        double differences = 0;
        for (Eigen::Index dv = -1; dv <= 1; ++dv) {
          for (Eigen::Index du = -1; du <= 1; ++du) {
            const std::complex<double> other = phasor(phases, m, v + dv, u + du);
            if (std::isnan(other.real())) continue;
            if (strong && std::abs(other) < options.min_amplitude) continue;
            const double d = 0.5 * (1 - std::cos(std::arg(other) - std::arg(own)));
            const double sigma2 = options.spatial_sigma_px * options.spatial_sigma_px;
            const double weight = std::exp(-static_cast<double>(dv * dv + du * du) / (2 * sigma2)) *
                                  std::exp(strong ? -options.steepness * d : 0.0);
            sum += weight * other;
            weights += weight;
            differences += d;
          }
        }
        on_edge = on_edge || differences >= options.edge_limit;
        const std::complex<double> found = phasor(smoothed.phases, m, v, u);
        EXPECT_NEAR(std::abs(found - sum / weights), 0, 1e-4);
      }
      EXPECT_EQ(smoothed.on_edge(v, u) != 0, on_edge);
    }
  }
}

TEST(PhaseSmoothing, OutermostPixelsStay) {
  const ThreePhases phases = random_phases(5);
  const SmoothedPhases smoothed = smooth_phases(phases);
  EXPECT_TRUE(same_values(smoothed.phases.phase_cycles[1].row(0), phases.phase_cycles[1].row(0)));
  EXPECT_TRUE(same_values(smoothed.phases.amplitude[2].col(20), phases.amplitude[2].col(20)));
}

}  // namespace
}  // namespace tofmap::peers
