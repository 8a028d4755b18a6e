// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/ideal_frame.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

SimulatorOptions small_image() {
  SimulatorOptions options;
  options.width_px = 40;
  options.height_px = 24;
  return options;
}

SimulatorOptions every_error() {
  SimulatorOptions options = small_image();
  options.range_noise_m = 0.05;
  options.wiggle_m = 0.01;
  options.dark_level = 30;
  options.multipath_rays = 4;
  options.offset_b_m = 0.05;
  options.periodic_a_m = 0.03;
  options.periodic_b_m = 0.02;
  options.amplitude_error_b_m = 0.03;
  options.fixed_pattern_m = 0.01;
  options.errors_seed = 5;
  options.ambient_noise = 4;
  options.phase_bits = 9;
  options.b_delay_share = 1;
  options.seed = 9;
  return options;
}

void expect_same_bits(const Frame& one, const Frame& other) {
  EXPECT_EQ(one.index, other.index);
  EXPECT_EQ(one.timestamp_s, other.timestamp_s);
  EXPECT_TRUE(same_values(one.phases[0], other.phases[0]));
  EXPECT_TRUE(same_values(one.phases[1], other.phases[1]));
  EXPECT_TRUE(same_values(one.amplitudes[0], other.amplitudes[0]));
  EXPECT_TRUE(same_values(one.amplitudes[1], other.amplitudes[1]));
}

TEST(MeasuredFrame, HasTheBitsThatTheSimulatorMakes) {
  for (const SimulatorOptions& options : {small_image(), every_error()}) {
    const Simulator simulator(make_scene("room"), options);
    const SimulatedFrame simulated = simulator.simulate(7);
    const IdealFrame ideal = simulator.ideal(7);
    expect_same_bits(measured_frame(ideal, simulator.sensor(), options), simulated.frame);
    EXPECT_TRUE(same_values(ideal.range_truth_m, simulated.range_truth_m));
  }
}

TEST(MeasuredFrame, TakesErrorsThatTheSimulatorDidNotHave) {
  SimulatorOptions options = every_error();
  options.wiggle_m = 0;  // these two belong to the light, not to the measurement
  options.multipath_rays = 0;
  SimulatorOptions without = small_image();
  without.b_delay_share = options.b_delay_share;
  const IdealFrame ideal = Simulator(make_scene("room"), without).ideal(7);
  const Simulator with(make_scene("room"), options);
  expect_same_bits(measured_frame(ideal, with.sensor(), options), with.simulate(7).frame);
}

TEST(IdealFrame, KeepsSignalsThatAreTooWeakToMeasure) {
  // 6000 × 0.002 / 25 m² is 0.48: as an amplitude it rounds to zero.
  SimulatorOptions options = small_image();
  options.range_noise_m = 0;
  const Simulator simulator(test::facing_wall_scene(5, 0.002), options);
  const IdealFrame ideal = simulator.ideal(0);
  EXPECT_FALSE(ideal.signals[0].real().isNaN().any());
  EXPECT_TRUE(measured_frame(ideal, simulator.sensor(), options).phases[0].isNaN().all());
}

TEST(MeasuredFrame, RefusesImagesOfAnotherSize) {
  const Simulator simulator(test::facing_wall_scene(5, 0.5), small_image());
  SensorModel other = simulator.sensor();
  other.camera.width_px = 41;
  EXPECT_THROW(measured_frame(simulator.ideal(0), other, small_image()), UsageError);
}

}  // namespace
}  // namespace tofmap
