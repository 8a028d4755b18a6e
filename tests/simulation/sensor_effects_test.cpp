// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// Of the ranges of A.
ImageF range_error_m(const SimulatedFrame& simulated, double wavelength_m) {
  return test::range_error_m(simulated.frame.phases[0], simulated.range_truth_m, wavelength_m);
}

TEST(Wiggling, SwingsFourTimesAWavelengthByTheAmplitudeWanted) {
  SimulatorOptions options = test::ideal_camera();
  options.wiggle_m = 0.02;
  const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(0);
  const SimulatedFrame simulated = simulator.simulate(0);
  const ImageF error_m = range_error_m(simulated, wavelength_m);
  for (Eigen::Index i = 0; i < error_m.size(); ++i) {
    const double phase = 2 * std::numbers::pi * simulated.range_truth_m.data()[i] / wavelength_m;
    // To first order in the harmonic, 2.4 %.
    EXPECT_NEAR(error_m.data()[i], -options.wiggle_m * std::sin(4 * phase),
                0.03 * options.wiggle_m);
  }
}

TEST(Wiggling, SwingsAsManyDegreesAtB) {
  SimulatorOptions options = test::ideal_camera();
  options.wiggle_m = 0.02;
  const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
  SimulatedFrame simulated = simulator.simulate(0);
  const Modulation& modulation = simulator.sensor().modulation;
  simulated.frame.phases[0] = simulated.frame.phases[1];
  const ImageF error_m = range_error_m(simulated, modulation.wavelength_m(1));
  const double wiggle_b_m =
      options.wiggle_m * modulation.wavelength_m(1) / modulation.wavelength_m(0);
  for (Eigen::Index i = 0; i < error_m.size(); ++i) {
    const double phase =
        2 * std::numbers::pi * simulated.range_truth_m.data()[i] / modulation.wavelength_m(1);
    EXPECT_NEAR(error_m.data()[i], -wiggle_b_m * std::sin(4 * phase), 0.03 * wiggle_b_m);
  }
}

/// Two walls that meet at a right angle 2 m ahead, each at 45 degrees to the view.
Scene corner_scene() {
  Scene scene;
  add_quad(scene.surface, {2, 0, -20}, {-10, 10, 0}, {0, 0, 40}, 0.8);
  add_quad(scene.surface, {2, 0, -20}, {-10, -10, 0}, {0, 0, 40}, 0.8);
  const Eigen::Vector3d ahead(1, 0, 0);
  scene.path = CameraPath({{{0, 0, 0}, ahead}, {{0, 0, 0}, ahead}}, false);
  scene.min_frames = 2;
  scene.max_range_m = 60;
  return scene;
}

TEST(Multipath, BendsACorner) {
  SimulatorOptions options = test::ideal_camera();
  options.multipath_rays = 256;
  const Simulator simulator(corner_scene(), options);
  const ImageF error_m =
      range_error_m(simulator.simulate(0), simulator.sensor().modulation.wavelength_m(0));
  EXPECT_GT(error_m.minCoeff(), 0) << "light by way of another wall has come farther";
  const Eigen::Index middle = options.width_px / 2;
  const float at_corner_m = error_m.col(middle).mean();
  const float at_side_m = error_m.col(2).mean();
  EXPECT_GT(at_side_m, 0.02F) << "the other wall is seen from there, too";
  EXPECT_GT(std::abs(at_side_m - at_corner_m), 0.01F) << "so the walls are no planes any more";
  // Both walls alike; 256 rays a pixel leave some millimetres of noise, 24 rows average it.
  EXPECT_NEAR(error_m.col(8).mean(), error_m.col(options.width_px - 9).mean(), 2e-3);
}

TEST(Multipath, IsNotThereBeforeAFlatWall) {
  SimulatorOptions options = test::ideal_camera();
  options.multipath_rays = 64;
  const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
  const Simulator without(test::facing_wall_scene(3, 0.5), test::ideal_camera());
  EXPECT_TRUE((simulator.simulate(0).frame.phases[0] == without.simulate(0).frame.phases[0]).all());
}

TEST(FullWell, TakesAmplitudeFromWhatIsTooBright) {
  // At 1 m the amplitude is 3000, so samples hold up to 6000.
  SimulatorOptions options = test::ideal_camera();
  const Scene scene = test::facing_wall_scene(1, 0.5);
  const float plain = Simulator(scene, options).simulate(0).frame.amplitudes[0](12, 20);
  EXPECT_NEAR(plain, 3000, 5);
  float last = plain;
  for (const double full_well : {7000.0, 5000.0, 4000.0, 3000.0, 1000.0}) {
    options.full_well = full_well;
    const Simulator simulator(scene, options);
    const float amplitude = simulator.simulate(0).frame.amplitudes[0](12, 20);
    if (full_well > 6000) {
      EXPECT_EQ(amplitude, plain);
    } else {
      EXPECT_LT(amplitude, last) << full_well;
    }
    last = amplitude;
  }
}

TEST(DarkLevel, AddsItsShotNoiseAndLeavesLessRoom) {
  SimulatorOptions options = test::ideal_camera();
  options.dark_level = 200;
  const Simulator simulator(test::facing_wall_scene(5, 0.5), options);
  const SimulatedFrame simulated = simulator.simulate(0);
  const ImageF& amplitude = simulated.frame.amplitudes[0];
  const double mean = amplitude.mean();
  // Amplitudes differ over the view: neighbours in a row, by hardly anything but noise.
  const double differences =
      std::sqrt((amplitude.rightCols(39) - amplitude.leftCols(39)).square().mean() / 2);
  EXPECT_NEAR(differences, std::sqrt(options.dark_level / 2), 0.1 * std::sqrt(100));
  EXPECT_NEAR(mean,
              Simulator(test::facing_wall_scene(5, 0.5), test::ideal_camera())
                  .simulate(0)
                  .frame.amplitudes[0]
                  .mean(),
              2)
      << "charge that all samples have is no signal";
  options.full_well = 330;  // enough for twice the amplitude of 120, but not on top of the charge
  EXPECT_LT(
      Simulator(test::facing_wall_scene(5, 0.5), options).simulate(0).frame.amplitudes[0].mean(),
      0.95 * mean);
}

/// A dark wall and a bright one side by side, in one plane; the camera moves across them.
Scene two_tone_scene() {
  Scene scene;
  add_quad(scene.surface, {3, -60, -60}, {0, 60, 0}, {0, 0, 120}, 0.1);
  add_quad(scene.surface, {3, 0, -60}, {0, 60, 0}, {0, 0, 120}, 0.9);
  const Eigen::Vector3d ahead(1, 0, 0);
  scene.path = CameraPath({{{0, -3, 0}, ahead}, {{0, 3, 0}, ahead}}, false);
  scene.min_frames = 9;
  scene.max_range_m = 60;
  return scene;
}

TEST(Exposure, MovesRangesWhereTheSurfaceChangesBetweenSamples) {
  SimulatorOptions options = test::ideal_camera();
  options.max_translation_m = 0.3;  // three pixels of the wall
  const auto worst_m = [&](double exposure_share) {
    options.exposure_share = exposure_share;
    const Simulator simulator(two_tone_scene(), options);
    const int middle = *simulator.frame_count() / 2;
    return range_error_m(simulator.simulate(middle), simulator.sensor().modulation.wavelength_m(0))
        .abs()
        .maxCoeff();
  };
  EXPECT_LT(worst_m(0), 1e-4F);
  EXPECT_GT(worst_m(0.8), 0.1F) << "samples of two surfaces make no phase of either";
}

TEST(Exposure, DoesNotMatterWhereTheCameraStandsStill) {
  SimulatorOptions options = test::ideal_camera();
  options.exposure_share = 0.8;
  const Simulator simulator(corner_scene(), options);
  const Simulator without(corner_scene(), test::ideal_camera());
  const ImageF phase = simulator.simulate(0).frame.phases[0];
  EXPECT_LT((phase - without.simulate(0).frame.phases[0]).abs().maxCoeff(), 1e-6F);
}

}  // namespace
}  // namespace tofmap
