// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The rotation between two exposures, by their amplitudes alone, beside the simulated camera's.

#include "errors/exposure_alignment.hpp"

#include "simulated_turn.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

TEST(ExposureAlignment, FindsTheRotationToItsCovariance) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.max_rotation_deg = 4;
  const Simulator simulator(make_scene("flat"), options);
  for (const int index : {3, 12, 21, 30}) {
    const SimulatedFrame one = simulator.simulate(index);
    const SimulatedFrame other = simulator.simulate(index + 1);
    const auto found = align_exposures(one.frame.amplitudes[0], other.frame.amplitudes[0],
                                       simulator.sensor().camera);
    ASSERT_TRUE(found) << index;
    const Eigen::Vector3d translation_m =
        (one.world_from_camera.inverse() * other.world_from_camera).translation();
    // Parallax of surfaces a metre away and more, besides.
    const double parallax_rad = translation_m.norm();
    const Eigen::Vector3d off_rad = found->rotation_rad - test::turn_between(one, other);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double sigma_rad = std::sqrt(found->covariance_rad2(k, k));
      EXPECT_LT(std::abs(off_rad[k]), 3 * sigma_rad + parallax_rad) << index << ", axis " << k;
      EXPECT_LT(sigma_rad, 0.02) << index;
    }
  }
}

TEST(ExposureAlignment, SaysNothingOfDarkAndOfTinyImages) {
  const CameraModel camera{
      .width_px = 88, .height_px = 72, .fx_px = 64, .fy_px = 64, .cx_px = 43.5, .cy_px = 35.5};
  const ImageF dark = ImageF::Zero(72, 88);
  EXPECT_FALSE(align_exposures(dark, dark, camera));
  const ImageF tiny = ImageF::Ones(6, 6);
  EXPECT_FALSE(align_exposures(tiny, tiny, camera));
}

TEST(ExposureAlignment, KnowsThatAnEvenImageTellsNothing) {
  const CameraModel camera{
      .width_px = 88, .height_px = 72, .fx_px = 64, .fy_px = 64, .cx_px = 43.5, .cy_px = 35.5};
  std::mt19937 random(3);
  std::normal_distribution<float> normal(100, 5);
  const auto noisy = [&] {
    return ImageF(ImageF::NullaryExpr(72, 88, [&] { return normal(random); }));
  };
  const auto found = align_exposures(noisy(), noisy(), camera);
  // Either nothing, or a rotation of which nothing is known: wider than a late exposure's prior.
  if (!found) return;
  EXPECT_GT(found->covariance_rad2(0, 0), 0.06 * 0.06);
  EXPECT_GT(found->covariance_rad2(1, 1), 0.06 * 0.06);
}

}  // namespace
}  // namespace tofmap
