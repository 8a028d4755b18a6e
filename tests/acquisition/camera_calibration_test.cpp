// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr double pi = std::numbers::pi;

PhaseError wiggle() { return {.offset_m = 0.02, .harmonics = {{4, 0.003, -0.01}, {8, 0, 0.001}}}; }

TEST(PhaseError, IsOffsetHarmonicsAndTable) {
  PhaseError error = wiggle();
  const double phase = 0.3;
  const double harmonics_m = 0.003 * std::cos(8 * pi * phase) - 0.01 * std::sin(8 * pi * phase) +
                             0.001 * std::sin(16 * pi * phase);
  EXPECT_NEAR(error.at_m(phase), 0.02 + harmonics_m, 1e-12);
  EXPECT_NEAR(error.at_m(phase - 3), error.at_m(phase), 1e-12) << "it is periodic";
  error.table_m = {0, 0.1, 0.2, 0.1};
  EXPECT_NEAR(error.at_m(0.3), 0.02 + harmonics_m + 0.12, 1e-12);
  EXPECT_NEAR(PhaseError{.table_m = error.table_m}.at_m(0.875), 0.05, 1e-12) << "on to the first";
}

TEST(Calibration, TakesTheErrorOutOfBothPhases) {
  const Modulation modulation{29e6, 31e6};
  CameraCalibration calibration;
  calibration.errors.resize(2);
  calibration.errors[0] = wiggle();
  calibration.errors[1] = {.offset_m = -0.3};
  Frame frame = blank_frame(2);
  frame.phases[0].resize(1, 1000);
  frame.phases[1].resize(1, 1000);
  for (int i = 0; i < 1000; ++i) {
    frame.phases[0](0, i) = static_cast<float>(i) / 1000;
    frame.phases[1](0, i) = static_cast<float>(i) / 1000;
  }
  frame.phases[0](0, 7) = NAN;
  calibrate(frame, modulation, calibration);
  EXPECT_TRUE(std::isnan(frame.phases[0](0, 7)));
  for (int i = 8; i < 1000; ++i) {
    const double measured = i / 1000.0;
    const double wanted = measured - wiggle().at_m(measured) / modulation.wavelength_m(0);
    const double off = frame.phases[0](0, i) - wanted;
    EXPECT_NEAR(off - std::round(off), 0, 1e-5) << i;
    EXPECT_GE(frame.phases[1](0, i), 0);
    EXPECT_LT(frame.phases[1](0, i), 1);
  }
}

class CalibrationFile : public testing::Test {
 protected:
  std::string complaint(const std::string& text) const {
    const auto file = folder_.path() / "camera.yaml";
    std::ofstream(file) << text;
    try {
      read_calibration(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
};

TEST_F(CalibrationFile, ReadsBackAsTheSameBits) {
  CameraCalibration calibration;
  calibration.camera = CameraModel{.width_px = 4,
                                   .height_px = 3,
                                   .fx_px = 2.1,
                                   .fy_px = 2.2,
                                   .cx_px = 1.5,
                                   .cy_px = 1,
                                   .distortion = {0.1, 0, 0, 0, 0.01}};
  calibration.errors.resize(2);
  calibration.errors[0] = wiggle();
  calibration.errors[1] = {.offset_m = 1.0 / 3, .harmonics = {}, .table_m = {0.1, 1e-7, -0.3}};
  calibration.saturation_amplitude = 4000;
  calibration.with = CalibratedWith{4, 3, {29e6, 30.9999e6}};
  const auto file = folder_.path() / "camera.yaml";
  write_calibration(file, calibration);
  const CameraCalibration read = read_calibration(file);
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->distortion, calibration.camera->distortion);
  EXPECT_EQ(read.camera->fy_px, 2.2);
  ASSERT_EQ(read.errors[0].harmonics.size(), 2U);
  EXPECT_EQ(read.errors[0].harmonics[0].sine_m, -0.01);
  EXPECT_EQ(read.errors[1].offset_m, 1.0 / 3);
  EXPECT_EQ(read.errors[1].table_m, calibration.errors[1].table_m);
  EXPECT_EQ(read.saturation_amplitude, 4000);
  ASSERT_TRUE(read.with);
  EXPECT_EQ(read.with->height_px, 3);
  EXPECT_EQ(read.with->modulation.frequencies_hz[1], 30.9999e6);
}

TEST_F(CalibrationFile, ThatIsWrongIsNamedWithItsKey) {
  const std::string head = "format: tofmap-camera\nversion: 1\n";
  EXPECT_EQ(complaint(head), "");
  EXPECT_THAT(complaint("format: tofmap-sequence\nversion: 1\n"),
              testing::HasSubstr("tofmap-camera"));
  EXPECT_THAT(complaint(head + "error_a: {ofset_m: 1}\n"), testing::HasSubstr("error_a.ofset_m"));
  EXPECT_THAT(complaint(head + "error_b: {offset_m: far}\n"),
              testing::HasSubstr("error_b.offset_m"));
  EXPECT_THAT(complaint(head + "error_b: {offset_m: .nan}\n"),
              testing::HasSubstr("error_b.offset_m"));
  EXPECT_THAT(complaint(head + "error_b: {offset_m: 1e300}\n"),
              testing::HasSubstr("error_b.offset_m"));
  EXPECT_THAT(complaint(head + "error_a: {table_m: [0, .inf]}\n"),
              testing::HasSubstr("error_a.table_m"));
  EXPECT_THAT(complaint(head + "error_a: {}\nerror_a: {}\n"), testing::HasSubstr("twice"));
  EXPECT_THAT(complaint(head + "error_a: {harmonics: [{order: 4, cosine_m: 0, sine_m: 0}, "
                               "{order: 4, cosine_m: 0, sine_m: 0}]}\n"),
              testing::HasSubstr("order 4 twice"));
  EXPECT_THAT(complaint(head + "saturation_amplitude: 1e9\n"), testing::HasSubstr("saturation"));
  EXPECT_THAT(complaint(head + "camera: {width: 176, height: 144, fx: 1e9, fy: 128, cx: 88, "
                               "cy: 72}\n"),
              testing::HasSubstr("fx"));
  EXPECT_THAT(complaint(head + "error_a: {harmonics: [{order: 0, cosine_m: 0, sine_m: 0}]}\n"),
              testing::HasSubstr("order"));
  EXPECT_THAT(complaint(head + "error_a: {harmonics: 4}\n"), testing::HasSubstr("list"));
  EXPECT_THAT(complaint(head + "saturation_amplitude: -1\n"), testing::HasSubstr("saturation"));
  EXPECT_THAT(complaint(head + "camera: {width: 4}\n"), testing::HasSubstr("camera.height"));
  EXPECT_THAT(complaint("["), testing::HasSubstr("camera.yaml"));
}

TEST(Calibration, ThatNoCameraCouldHaveIsRefused) {
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  CameraCalibration calibration;
  // Of order 4, this much rises as fast as the range where it is steepest.
  const double steepest_m = sensor.modulation.wavelength_m(1) / (8 * pi);
  calibration.errors.resize(2);
  calibration.errors[1].harmonics = {{4, 0, 0.98 * steepest_m}};
  EXPECT_NO_THROW(calibrated(sensor, calibration));
  calibration.errors[1].harmonics = {{4, 0, 1.02 * steepest_m}};
  EXPECT_THROW(calibrated(sensor, calibration), InputError);
  calibration.errors[1] = {.table_m = {0, 5}};
  EXPECT_THROW(calibrated(sensor, calibration), InputError);
}

TEST(Calibration, OfAnotherCameraIsRefused) {
  SensorModel sensor;
  sensor.camera = {.width_px = 4, .height_px = 3, .fx_px = 2, .fy_px = 2, .cx_px = 1.5, .cy_px = 1};
  CameraCalibration calibration;
  calibration.camera = sensor.camera;
  calibration.camera->fx_px = 2.5;
  calibration.saturation_amplitude = 900;
  EXPECT_EQ(calibrated(sensor, calibration).camera.fx_px, 2.5);
  EXPECT_EQ(calibrated(sensor, calibration).saturation_amplitude, 900);
  calibration.camera->width_px = 5;
  EXPECT_THROW(calibrated(sensor, calibration), InputError);
}

TEST(Calibration, FoundWithOtherFrequenciesOrImagesIsRefused) {
  SensorModel sensor;
  sensor.camera = {.width_px = 4, .height_px = 3, .fx_px = 2, .fy_px = 2, .cx_px = 1.5, .cy_px = 1};
  sensor.modulation = {29e6, 31e6};
  CameraCalibration calibration;
  calibration.with = CalibratedWith{4, 3, sensor.modulation};
  EXPECT_NO_THROW(calibrated(sensor, calibration));
  calibration.with->modulation = {80e6, 100e6};
  EXPECT_THROW(calibrated(sensor, calibration), InputError);
  calibration.with = CalibratedWith{3, 4, sensor.modulation};
  EXPECT_THROW(calibrated(sensor, calibration), InputError);
}

}  // namespace
}  // namespace tofmap
