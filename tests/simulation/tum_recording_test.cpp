// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/tum_recording.hpp>

namespace tofmap {
namespace {

using testing::HasSubstr;

/// Two depth images of 64 x 48 pixels, and poses between and around their times.
class TumFolder : public testing::Test {
 protected:
  TumFolder() {
    options_.fx_px = options_.fy_px = 60;
    options_.cx_px = 31.5;
    options_.cy_px = 23.5;
    simulator_.frequency_a_hz = 80e6;
    simulator_.frequency_b_hz = 100e6;
    std::filesystem::create_directory(path("depth"));
    ImageU16 depth = ImageU16::Constant(48, 64, 20000);  // 4 m
    depth.topRows(8).setZero();
    write_png(path("depth/1.png"), depth);
    write_png(path("depth/2.png"), depth);
    write("depth.txt", "# depth maps\n# timestamp filename\n10.0 depth/1.png\n10.5 depth/2.png\n");
    write("groundtruth.txt", "9.95 0 0 0 0 0 0 1\n10.05 1 0 0 0 0 0 1\n");
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }
  TumRecording open() const { return {folder_.path(), options_, simulator_}; }

  std::string complaint() const {
    try {
      open().read(1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  test::TemporaryFolder folder_;
  TumOptions options_;
  SimulatorOptions simulator_;
};

TEST_F(TumFolder, IsWrappedAtTheFrequenciesWanted) {
  simulator_.range_noise_m = 0;
  const TumRecording recording = open();
  EXPECT_EQ(recording.frame_count(), 2);
  const SensorModel& sensor = recording.sensor();
  EXPECT_EQ(sensor.camera.width_px, 32);
  EXPECT_EQ(sensor.camera.height_px, 24);
  EXPECT_EQ(sensor.modulation.frequencies_hz[1], 100e6);
  const TumRecording::FrameWithTruth read = recording.read(1);
  EXPECT_EQ(read.frame.timestamp_s, 10.5);
  EXPECT_TRUE(std::isnan(read.frame.phases[0](3, 5))) << "there was no depth";
  EXPECT_TRUE(std::isnan(read.range_truth_m(3, 5)));
  for (const auto& [v, u] : {std::pair(10, 3), std::pair(23, 31)}) {
    // Of two by two pixels the last is taken: the ray is that of the original's pixel.
    const Eigen::Vector3d ray((2 * u + 1 - 31.5) / 60, (2 * v + 1 - 23.5) / 60, 1);
    const double range_m = 4 * ray.norm();
    EXPECT_NEAR(read.range_truth_m(v, u), range_m, 1e-5);
    const double wraps = range_m / sensor.modulation.wavelength_m(0);
    EXPECT_NEAR(read.frame.phases[0](v, u), wraps - std::floor(wraps), 1e-5);
    const double wraps_b = range_m / sensor.modulation.wavelength_m(1);
    EXPECT_NEAR(read.frame.phases[1](v, u), wraps_b - std::floor(wraps_b), 1e-5);
    EXPECT_NEAR(read.frame.amplitudes[0](v, u), amplitude_unit * 0.5 / (range_m * range_m), 0.01);
  }
}

TEST_F(TumFolder, HasTheNoiseWanted) {
  simulator_.range_noise_m = 0.05;
  const TumRecording recording = open();
  const TumRecording::FrameWithTruth read = recording.read(0);
  const double wavelength_m = recording.sensor().modulation.wavelength_m(0);
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < read.range_truth_m.size(); ++i) {
    const double truth_m = read.range_truth_m.data()[i];
    const double off = read.frame.phases[0].data()[i] - truth_m / wavelength_m;
    if (std::isnan(off)) continue;
    // Noise goes as the square of the range.
    sum += std::pow(wavelength_m * (off - std::round(off)) * 25 / (truth_m * truth_m), 2);
    ++count;
  }
  EXPECT_NEAR(std::sqrt(sum / count), 0.05, 0.005) << "of 640 pixels";
  EXPECT_FALSE((recording.read(0).frame.phases[0] == recording.read(1).frame.phases[0]).all());
}

TEST_F(TumFolder, HasTheSensorsEffectsWanted) {
  simulator_.range_noise_m = 0;
  const TumRecording::FrameWithTruth ideal = open().read(0);
  simulator_.wiggle_m = 0.01;
  const TumRecording::FrameWithTruth wiggling = open().read(0);
  const double wavelength_m = open().sensor().modulation.wavelength_m(0);
  const double largest_m =
      wavelength_m * double{(wiggling.frame.phases[0] - ideal.frame.phases[0])
                                .isNaN()
                                .select(0.F, wiggling.frame.phases[0] - ideal.frame.phases[0])
                                .abs()
                                .maxCoeff()};
  EXPECT_NEAR(largest_m, 0.01, 0.002) << "all phases occur from 4 to 4.9 m";
  simulator_.wiggle_m = 0;
  simulator_.full_well = 200;  // the amplitude at 4 m is 187, and a sample holds twice that
  EXPECT_LT(open().read(0).frame.amplitudes[0].maxCoeff(),
            ideal.frame.amplitudes[0].maxCoeff() - 10);
  simulator_.full_well = 0;
  simulator_.max_range_m = 4.2;
  const ImageF near_only = open().read(0).frame.phases[0];
  EXPECT_TRUE(
      (near_only.isNaN() == (ideal.range_truth_m > 4.2F || ideal.range_truth_m.isNaN())).all());
}

TEST_F(TumFolder, HasTheSystematicErrorsWanted) {
  simulator_.range_noise_m = 0;
  simulator_.offset_b_m = 0.05;
  simulator_.phase_bits = 16;
  const TumRecording::FrameWithTruth shifted = open().read(0);
  const double wavelength_m = open().sensor().modulation.wavelength_m(1);
  for (const auto& [v, u] : {std::pair(10, 3), std::pair(23, 31)}) {
    const double off = (double{shifted.range_truth_m(v, u)} + 0.05) / wavelength_m -
                       double{shifted.frame.phases[1](v, u)};
    EXPECT_NEAR(off, std::round(off), 1e-5);
    const float level = 65536 * shifted.frame.phases[1](v, u);
    EXPECT_EQ(level, std::round(level));
  }
  simulator_.phase_bits = 2;
  EXPECT_THROW(open(), UsageError);
}

TEST_F(TumFolder, HasAmbientLightInItsPartOfTheImageAlone) {
  const TumRecording::FrameWithTruth dark = open().read(0);
  simulator_.ambient_noise = 4;
  const TumRecording::FrameWithTruth lit = open().read(0);
  const auto changed = [&](Eigen::Index v, Eigen::Index u) {
    return lit.frame.phases[1](v, u) != dark.frame.phases[1](v, u);
  };
  EXPECT_TRUE(changed(11, 16)) << "the right upper quarter is lit by default";
  EXPECT_FALSE(changed(11, 15));
  EXPECT_FALSE(changed(12, 16));
}

TEST_F(TumFolder, RefusesOptionsThatNeedAScene) {
  simulator_.multipath_rays = 8;
  try {
    open();
    ADD_FAILURE() << "they were taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("simulator.multipath_rays"));
  }
}

TEST_F(TumFolder, IsOpenedByTheFirstImageThatCanBeRead) {
  std::filesystem::remove(path("depth/1.png"));
  const TumRecording recording = open();
  EXPECT_EQ(recording.sensor().camera.width_px, 32);
  EXPECT_THROW(recording.read(0), InputError);
  EXPECT_FALSE(recording.read(1).frame.phases[0].isNaN().all());
}

TEST_F(TumFolder, KeepsPosesThatAreNearInTime) {
  const TumRecording recording = open();
  EXPECT_NEAR(recording.read(0).world_from_camera.value().translation().x(), 0.5, 1e-9);
  EXPECT_FALSE(recording.read(1).world_from_camera);
  std::filesystem::remove(path("groundtruth.txt"));
  EXPECT_FALSE(open().read(0).world_from_camera);
}

TEST_F(TumFolder, NamesWhatCannotBeRead) {
  write_png(path("depth/2.png"), ImageU16(ImageU16::Constant(30, 64, 1)));
  EXPECT_THAT(complaint(), HasSubstr("depth/2.png"));
  std::filesystem::remove(path("depth/2.png"));
  EXPECT_THAT(complaint(), HasSubstr("depth/2.png"));
  write("depth.txt", "10 depth/1.png\n10 depth/2.png\n11 depth/1.png\n");
  EXPECT_EQ(open().frame_count(), 2);
  ASSERT_EQ(open().left_out().size(), 1U);
  EXPECT_THAT(open().left_out()[0], HasSubstr("depth.txt:2"));
  write("depth.txt", "10\n");
  EXPECT_THAT(complaint(), HasSubstr("depth.txt:1"));
  write("depth.txt", "# nothing\n");
  EXPECT_THAT(complaint(), HasSubstr("lists no image"));
  std::filesystem::remove(path("depth.txt"));
  EXPECT_THAT(complaint(), HasSubstr("depth.txt"));
}

}  // namespace
}  // namespace tofmap
