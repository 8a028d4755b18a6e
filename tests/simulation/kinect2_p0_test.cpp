// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/simulation/kinect2_p0.hpp>

namespace tofmap {
namespace {

/// The offsets of a table as lengths in metres, without the outermost columns.
Eigen::ArrayXXd lengths_m(const kinect2::P0Tables& p0, std::size_t frequency) {
  const double wavelength_m = speed_of_light_m_per_s / (2 * kinect2::frequencies_hz[frequency]);
  const Eigen::ArrayXXd values = p0.tables[frequency].cast<double>();
  return values.middleCols(1, 510) * kinect2::cycles_per_p0_unit * wavelength_m;
}

TEST(SyntheticP0Tables, AreTheSameForTheSameSeedAndDifferForOthers) {
  const kinect2::P0Tables first = synthetic_p0_tables(1);
  const kinect2::P0Tables again = synthetic_p0_tables(1);
  const kinect2::P0Tables other = synthetic_p0_tables(2);
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_TRUE((first.tables[f] == again.tables[f]).all());
    EXPECT_GT((lengths_m(first, f) - lengths_m(other, f)).abs().maxCoeff(), 0.01);
  }
}

TEST(SyntheticP0Tables, HaveTheValuesOfARealCameraInTheOutermostColumns) {
  const kinect2::P0Tables p0 = synthetic_p0_tables(3);
  const int values[] = {0x2c9a, 0x08ec, 0x42e8};
  for (std::size_t f = 0; f < 3; ++f) {
    for (const int u : {0, 511}) EXPECT_TRUE((p0.tables[f].col(u) == values[f]).all()) << f;
    // Inside, the same length is the middle of the values.
    const double wavelength_m = speed_of_light_m_per_s / (2 * kinect2::frequencies_hz[f]);
    const double edge_m = values[f] * kinect2::cycles_per_p0_unit * wavelength_m;
    EXPECT_NEAR(lengths_m(p0, f).mean(), edge_m, 0.02) << f;
    EXPECT_LT((lengths_m(p0, f) - edge_m).abs().maxCoeff(), 0.035) << f;
  }
}

TEST(SyntheticP0Tables, VarySmoothlyExceptForThePixelsOwnDeviations) {
  const Eigen::ArrayXXd length_m = lengths_m(synthetic_p0_tables(4), 2);
  const Eigen::ArrayXXd steps_m = length_m.rightCols(509) - length_m.leftCols(509);
  const double rms_m = std::sqrt(steps_m.square().mean());
  EXPECT_NEAR(rms_m, std::sqrt(2 * (0.002 * 0.002 + 0.001 * 0.001)), 1e-4);
  EXPECT_LT(std::abs(steps_m.mean()), 1e-4);
}

TEST(SyntheticP0Tables, AreNearlyTheSameLengthAtAllFrequencies) {
  const kinect2::P0Tables p0 = synthetic_p0_tables(5);
  const double rms_m = std::sqrt((lengths_m(p0, 0) - lengths_m(p0, 2)).square().mean());
  EXPECT_NEAR(rms_m, std::sqrt(2) * 0.001, 1e-4);
}

}  // namespace
}  // namespace tofmap
