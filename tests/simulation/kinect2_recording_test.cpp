// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// From a scene to packets of a Kinect v2, and back by Kinect2Source.

#include "sample_scenes.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/kinect2_source.hpp>
#include <tofmap/acquisition/kinect2/light_source.hpp>
#include <tofmap/acquisition/kinect2/mirror.hpp>
#include <tofmap/acquisition/kinect2/phases.hpp>
#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/kinect2_p0.hpp>
#include <tofmap/simulation/kinect2_recording.hpp>

namespace tofmap {
namespace {

/// A Kinect v2 without noise, mixed pixels, or motion within a frame.
SimulatorOptions ideal_kinect() {
  SimulatorOptions options = kinect2_simulator_options();
  options.subpixels = 1;
  options.range_noise_m = 0;
  options.b_delay_share = 0;
  options.frames = 2;
  return options;
}

/// Near on the left, far on the right, and so no mirror image of itself.
Simulator uneven_room() { return {test::edge_scene(0.1), ideal_kinect()}; }

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The largest error of a measurement of an amplitude, in units of packets: it is rounded to a
/// whole number, and then to the nearest code.
double largest_rounding(double amplitude) {
  const double step = amplitude < 256 ? 1 : std::exp2(std::floor(std::log2(amplitude / 128)));
  return 0.5 + step / 2;
}

class SimulatedKinect2 : public testing::Test {
 protected:
  std::filesystem::path recorded(const Simulator& simulator, int errors_seed = 1) const {
    simulate_kinect2(simulator, errors_seed, folder_.path() / "recording");
    return folder_.path() / "recording";
  }

  test::TemporaryFolder folder_;
};

TEST_F(SimulatedKinect2, IsImportedWithTheRangesOfTheScene) {
  const Simulator simulator = uneven_room();
  Kinect2Source source(kinect2::open_recording(recorded(simulator)));
  EXPECT_EQ(source.frame_count(), 2);
  EXPECT_EQ(source.recording().never_recorded, 0U);
  const ImageF truth_m = simulator.simulate(0).range_truth_m;
  const std::optional<SourcedFrame> sourced = source.next();
  ASSERT_TRUE(sourced && sourced->frame) << sourced->damage;
  for (std::size_t f = 0; f < 3; ++f) {
    const double wavelength_m = source.sensor().modulation.wavelength_m(f);
    const ImageF error_m = test::range_error_m(sourced->frame->phases[f], truth_m, wavelength_m);
    double sum_of_squares = 0;
    for (Eigen::Index v = 0; v < 424; ++v) {
      for (Eigen::Index u = 1; u < 511; ++u) {
        const double amplitude = sourced->frame->amplitudes[f](v, u) / kinect2_amplitude_scale;
        // Errors e of three steps shift the phase by up to 4/3 e / amplitude. One correction of the
        // light source for all ranges leaves up to 0.51 mm.
        const double limit_m = wavelength_m / (2 * std::numbers::pi) * 4 / 3 *
                                   largest_rounding(amplitude) / amplitude +
                               0.00052;
        ASSERT_LT(std::abs(error_m(v, u)), limit_m) << f << ": " << u << ", " << v;
        sum_of_squares += error_m(v, u) * error_m(v, u);
      }
    }
    const double rms_mm = 1000 * std::sqrt(sum_of_squares / (424 * 510));
    RecordProperty("rms_mm_" + std::to_string(f), std::to_string(rms_mm));
    EXPECT_LT(rms_mm, 0.0015 * wavelength_m * 1000) << f;
  }
}

TEST_F(SimulatedKinect2, IsImportedAsTheSimulatedCameraSeesItAndNotMirrored) {
  const Simulator simulator = uneven_room();
  Kinect2Source source(kinect2::open_recording(recorded(simulator)));
  const CameraModel& camera = source.sensor().camera;
  EXPECT_NEAR(camera.cx_px, simulator.sensor().camera.cx_px, 1e-9);
  EXPECT_NEAR(camera.fx_px, simulator.sensor().camera.fx_px, 1e-9);
  const SimulatedFrame simulated = simulator.simulate(0);
  EXPECT_LT(simulated.range_truth_m(212, 20), 3);   // left of the camera
  EXPECT_GT(simulated.range_truth_m(212, 490), 4);  // right of it
  const Frame frame = *source.next()->frame;
  // At 16 MHz, the wall is nearer than a wavelength.
  const double wavelength_m = source.sensor().modulation.wavelength_m(1);
  EXPECT_NEAR(frame.phases[1](212, 20) * wavelength_m, simulated.range_truth_m(212, 20), 0.02);
  EXPECT_NEAR(frame.phases[1](212, 490) * wavelength_m, simulated.range_truth_m(212, 490), 0.1);
}

TEST_F(SimulatedKinect2, SendsWhatOtherProgramsExpectMirroredAndLitFromBesideTheLens) {
  const Simulator simulator = uneven_room();
  const kinect2::Recording recording = kinect2::open_recording(recorded(simulator));
  const kinect2::Phases phases = kinect2::phases_from_measurements(
      kinect2::read_packet(recording.packets[0].file), recording.p0);
  const ImageF truth_m = kinect2::mirrored(simulator.simulate(0).range_truth_m);
  const double wavelength_m = speed_of_light_m_per_s / (2 * kinect2::frequencies_hz[1]);
  const Eigen::Vector3d source_m(kinect2::light_source_x_m, 0, 0);
  double sum_m = 0;
  for (const int u : {30, 100, 400, 480}) {
    for (int v = 100; v < 300; ++v) {
      const double half_path_m = phases.phase[1](v, u) * wavelength_m;
      const double range_m =
          kinect2::range_from_half_path(half_path_m, pixel_ray(recording.camera, u, v), source_m);
      EXPECT_NEAR(range_m, truth_m(v, u), 0.06);
      sum_m += (range_m - truth_m(v, u)) * (u < 256 ? -1 : 1);
    }
  }
  // A source on the other side would be 20 mm off, in opposite directions on the two sides.
  EXPECT_LT(std::abs(sum_m / 800), 0.001);
}

TEST_F(SimulatedKinect2, HasPacketsThatAreTheSameBytesWhenTheyAreEncodedAgain) {
  const kinect2::Recording recording = kinect2::open_recording(recorded(uneven_room()));
  ASSERT_EQ(recording.packets.size(), 2U);
  for (const kinect2::RecordedPacket& packet : recording.packets) {
    const std::vector<std::uint8_t> bytes = bytes_of(packet.file);
    EXPECT_EQ(kinect2::encode_packet(kinect2::read_packet(packet.file)), bytes);
  }
}

TEST_F(SimulatedKinect2, HasPacketsThatFollowFromTheImportedFramesToAUnit) {
  // Measurements from the phases and amplitudes that were decoded from a packet.
  const kinect2::Recording recording = kinect2::open_recording(recorded(uneven_room()));
  const kinect2::Measurements measured = kinect2::read_packet(recording.packets[0].file);
  const kinect2::Phases phases = kinect2::phases_from_measurements(measured, recording.p0);
  const kinect2::Measurements again =
      kinect2::measurements_from_phases(phases.phase, phases.amplitude, recording.p0);
  for (std::size_t f = 0; f < 3; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto off = again.steps[f][k].cast<int>() - measured.steps[f][k].cast<int>();
      // The mean of the three steps, which phase and amplitude do not hold, is of rounding alone.
      EXPECT_LE(off.abs().maxCoeff(), largest_rounding(1400) + 1) << f << k;
    }
  }
}

TEST_F(SimulatedKinect2, SaturatesWhereLightIsTooStrong) {
  const Simulator simulator(test::facing_wall_scene(0.25, 0.9), ideal_kinect());
  Kinect2Source source(kinect2::open_recording(recorded(simulator)));
  const Frame frame = *source.next()->frame;
  for (std::size_t f = 0; f < 3; ++f) {
    // The phase is no NaN, which would mean that there is no return.
    EXPECT_EQ(frame.phases[f](212, 256), 0);
    EXPECT_EQ(frame.amplitudes[f](212, 256), source.sensor().saturation_amplitude);
  }
}

TEST_F(SimulatedKinect2, LeavesTheOutermostColumnsWithoutReturn) {
  Kinect2Source source(kinect2::open_recording(recorded(uneven_room())));
  const Frame frame = *source.next()->frame;
  for (const int u : {0, 511}) {
    EXPECT_TRUE(frame.phases[0].col(u).isNaN().all());
    EXPECT_TRUE((frame.amplitudes[0].col(u) == 0).all());
  }
}

TEST_F(SimulatedKinect2, HasAmplitudesInProportionToTheSimulatedOnes) {
  const Simulator simulator = uneven_room();
  const SimulatedFrame simulated = simulator.simulate(0);
  Kinect2Source source(kinect2::open_recording(recorded(simulator)));
  const Frame frame = *source.next()->frame;
  const double factor = packet_units_per_amplitude * kinect2_amplitude_scale;
  for (std::size_t f = 0; f < 3; ++f) {
    for (const int u : {40, 250, 470}) {
      const double expected = factor * simulated.frame.amplitudes[f](200, u);
      EXPECT_NEAR(frame.amplitudes[f](200, u), expected,
                  4.0 / 3 * kinect2_amplitude_scale * largest_rounding(expected));
    }
  }
}

TEST_F(SimulatedKinect2, HasTruthAtTheTimesOfItsPackets) {
  SimulatorOptions options = ideal_kinect();
  const Simulator simulator(test::facing_wall_scene(3, 0.5, 0.05), options);
  const std::filesystem::path folder = recorded(simulator);
  Kinect2Source source(kinect2::open_recording(folder));
  const Trajectory truth = read_trajectory(folder / "groundtruth.txt");
  ASSERT_EQ(truth.size(), 2U);
  for (const StampedPose& pose : truth) {
    EXPECT_NEAR(source.next()->timestamp_s, pose.timestamp_s, 1e-6);
  }
  const ImageU16 range_mm = read_png_16(folder / "range_truth" / "000001.png");
  EXPECT_NEAR(range_mm(212, 256), 1000 * simulator.simulate(1).range_truth_m(212, 256), 0.51);
  EXPECT_TRUE(std::filesystem::exists(folder / "scene.ply"));
}

TEST_F(SimulatedKinect2, OfAnotherSeedIsAnotherCamera) {
  const kinect2::Recording recording = kinect2::open_recording(recorded(uneven_room(), 7));
  EXPECT_TRUE((recording.p0.tables[0] == synthetic_p0_tables(7).tables[0]).all());
  EXPECT_EQ(recording.serial, "simulated-7");
}

TEST_F(SimulatedKinect2, WithImagesOrFrequenciesThatPacketsCannotHoldIsWrongUse) {
  SimulatorOptions small = ideal_kinect();
  small.width_px = 176;
  EXPECT_THROW(recorded(Simulator(test::edge_scene(0), small)), UsageError);
  SimulatorOptions other = ideal_kinect();
  other.frequencies_hz = {80e6, 120e6, 16e6};
  EXPECT_THROW(recorded(Simulator(test::edge_scene(0), other)), UsageError);
}

TEST(Kinect2SimulatorOptions, AreThoseOfTheShippedFile) {
  SimulatorOptions from_file;
  OptionTable file;
  file.bind("simulator", from_file);
  file.load(std::filesystem::path(TOFMAP_SOURCE_DIR) / "configs/cameras/kinect2.yaml");
  SimulatorOptions built_in = kinect2_simulator_options();
  OptionTable table;
  table.bind("simulator", built_in);
  EXPECT_EQ(table.to_yaml(false), file.to_yaml(false));
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_NEAR(built_in.contrasts[f], 1 / kinect2::amplitude_factors[f], 1e-6);
  }
  constexpr double focal_length_px = 365.456;
  const double fov_deg = 2 * std::atan(256 / focal_length_px) * 180 / std::numbers::pi;
  EXPECT_NEAR(built_in.horizontal_fov_deg, fov_deg, 0.005);
}

}  // namespace
}  // namespace tofmap
