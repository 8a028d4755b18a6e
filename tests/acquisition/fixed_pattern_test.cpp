// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/fixed_pattern.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Errors of up to 3 cm that differ in every pixel and frequency; one pixel is unknown.
FixedPattern some_pattern(std::size_t frequencies) {
  FixedPattern pattern;
  for (std::size_t f = 0; f < frequencies; ++f) {
    ImageF error_m(3, 4);
    for (int i = 0; i < 12; ++i) {
      error_m.data()[i] = 0.03F * std::sin(static_cast<float>(i) + 5 * static_cast<float>(f));
    }
    error_m(1, 2) = nan;
    pattern.push_back(error_m);
  }
  return pattern;
}

/// A .npy file of format version 1 with this header and this many zeros of four bytes.
std::string npy_text(const std::string& header, std::size_t numbers) {
  std::string text = "\x93NUMPY\x01";
  text += '\0';
  text += static_cast<char>(header.size());
  text += '\0';
  return text + header + std::string(4 * numbers, '\0');
}

std::string npy_header(const std::string& type, const std::string& shape,
                       const std::string& fortran_order = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + fortran_order + ", 'shape': " + shape +
         ", }\n";
}

class FixedPatternFile : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

  /// What the reader says of the file; empty if nothing.
  std::string complaint() const {
    try {
      read_fixed_pattern(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::string complaint_about(const std::string& text) const {
    write(text);
    return complaint();
  }

  std::string complaint_about_error(float error_m) const {
    FixedPattern pattern = some_pattern(2);
    pattern[1](2, 3) = error_m;
    write_fixed_pattern(file_, pattern);
    return complaint();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "camera.npy";
};

TEST_F(FixedPatternFile, ReadsBackAsTheSameBits) {
  for (const std::size_t frequencies : {1U, 2U, 3U, 8U}) {
    const FixedPattern pattern = some_pattern(frequencies);
    write_fixed_pattern(file_, pattern);
    const FixedPattern read = read_fixed_pattern(file_);
    ASSERT_EQ(read.size(), frequencies);
    for (std::size_t f = 0; f < frequencies; ++f) EXPECT_TRUE(same_values(read[f], pattern[f]));
  }
}

TEST_F(FixedPatternFile, IsAnArrayOfNumpy) {
  write_fixed_pattern(file_, some_pattern(2));
  std::ifstream in(file_, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  ASSERT_EQ(text.size() % 32, 0U) << "24 numbers of four bytes, after a multiple of 64 bytes";
  const std::string header = text.substr(10, text.size() - 10 - 96);
  EXPECT_EQ(static_cast<std::size_t>(text[8]), header.size());
  EXPECT_EQ((header.size() + 10) % 64, 0U);
  EXPECT_THAT(header, AllOf(HasSubstr("'shape': (2, 3, 4)"), testing::EndsWith("\n")));
}

TEST_F(FixedPatternFile, ThatIsNoPatternIsNamedWithARemedy) {
  EXPECT_THAT(complaint(), AllOf(HasSubstr("camera.npy"), HasSubstr("keep both files")));
  EXPECT_THAT(complaint_about("depth"), AllOf(HasSubstr("camera.npy"), HasSubstr(".npy")));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f8", "(2, 3, 4)"), 48)),
              AllOf(HasSubstr("camera.npy"), HasSubstr("float64"), HasSubstr("astype('float32')")));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<i4", "(2, 3, 4)"), 24)),
              HasSubstr("astype('float32')"));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f4", "(3, 4)"), 12)),
              AllOf(HasSubstr("(3, 4)"), HasSubstr("(frequencies, rows, columns)")));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f4", "(9, 3, 4)"), 108)),
              HasSubstr("(9, 3, 4)"));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f4", "(2, 3, 4)", "True"), 24)),
              HasSubstr("ascontiguousarray"));
  EXPECT_EQ(complaint_about(npy_text(npy_header("<f4", "(2, 3, 4)"), 24)), "");
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f4", "(2, 3, 4)"), 23)),
              AllOf(HasSubstr("truncated"), HasSubstr("23 of the 24")));
  EXPECT_THAT(complaint_about(npy_text(npy_header("<f4", "(2, 3, 4)"), 25)), HasSubstr("promises"));
}

TEST_F(FixedPatternFile, HasErrorsThatCamerasHave) {
  EXPECT_EQ(complaint_about_error(0.5F), "");
  EXPECT_EQ(complaint_about_error(nan), "");
  EXPECT_THAT(complaint_about_error(-0.51F),
              AllOf(HasSubstr("camera.npy"), HasSubstr("-0.51 m at frequency 2"),
                    HasSubstr("are they metres?")));
  EXPECT_THAT(complaint_about_error(INFINITY), HasSubstr("are they metres?"));
  FixedPattern unknown = some_pattern(2);
  unknown[0].setConstant(nan);
  write_fixed_pattern(file_, unknown);
  EXPECT_THAT(complaint(), AllOf(HasSubstr("only NaN at frequency 1"), HasSubstr("write 0")));
}

TEST_F(FixedPatternFile, NeedsImagesOfOneSize) {
  FixedPattern pattern = some_pattern(2);
  pattern[1].resize(4, 3);
  EXPECT_THROW(write_fixed_pattern(file_, pattern), UsageError);
  EXPECT_THROW(write_fixed_pattern(file_, {}), UsageError);
}

TEST_F(FixedPatternFile, ThatCannotBeWrittenIsNamed) {
  EXPECT_THROW(write_fixed_pattern(folder_.path() / "none" / "camera.npy", some_pattern(1)),
               InputError);
}

class CalibrationWithPattern : public testing::Test {
 protected:
  CalibrationWithPattern() {
    calibration_.with = CalibratedWith{4, 3, {29e6, 31e6}};
    calibration_.fixed_pattern = some_pattern(2);
    calibration_.fixed_pattern_file = "its pattern.npy";
    write_calibration(file_, calibration_);
    write_fixed_pattern(pattern_file_, calibration_.fixed_pattern);
  }

  std::string complaint() const {
    try {
      read_calibration(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "camera.yaml";
  std::filesystem::path pattern_file_ = folder_.path() / "its pattern.npy";
  CameraCalibration calibration_;
};

TEST_F(CalibrationWithPattern, NamesTheFileBesideIt) {
  const CameraCalibration read = read_calibration(file_);
  EXPECT_EQ(read.fixed_pattern_file, "its pattern.npy");
  ASSERT_EQ(read.fixed_pattern.size(), 2U);
  EXPECT_TRUE(same_values(read.fixed_pattern[1], calibration_.fixed_pattern[1]));
  EXPECT_EQ(fixed_pattern_file_in(file_), "its pattern.npy");
  EXPECT_EQ(fixed_pattern_file_in(pattern_file_), "");
}

TEST_F(CalibrationWithPattern, IsReadThroughALink) {
  const test::TemporaryFolder elsewhere;
  std::filesystem::create_symlink(file_, elsewhere.path() / "link.yaml");
  EXPECT_EQ(read_calibration(elsewhere.path() / "link.yaml").fixed_pattern.size(), 2U);
}

TEST_F(CalibrationWithPattern, NamesTheFileThatIsMissingOrOfAnotherCamera) {
  write_fixed_pattern(pattern_file_, some_pattern(3));
  EXPECT_THAT(complaint(), AllOf(HasSubstr("its pattern.npy"), HasSubstr("(3, 3, 4)"),
                                 HasSubstr("(2, 3, 4)"), HasSubstr("another camera?")));
  std::filesystem::remove(pattern_file_);
  EXPECT_THAT(complaint(), AllOf(HasSubstr("its pattern.npy"), HasSubstr("keep both files")));
}

TEST_F(CalibrationWithPattern, TakesNoPathForAName) {
  for (const std::string name : {"../camera.npy", "/camera.npy", "camera.png", "''", "[1]"}) {
    std::ofstream(file_) << "format: tofmap-camera\nversion: 1\nfixed_pattern: " << name << '\n';
    EXPECT_THAT(complaint(), AllOf(HasSubstr("camera.yaml"), HasSubstr("fixed_pattern"),
                                   HasSubstr("must be the name of a .npy file")))
        << name;
    EXPECT_EQ(fixed_pattern_file_in(file_), "") << name;
  }
}

TEST_F(CalibrationWithPattern, IsRefusedForOtherCameras) {
  SensorModel sensor;
  sensor.camera = {.width_px = 4, .height_px = 3, .fx_px = 2, .fy_px = 2, .cx_px = 1.5, .cy_px = 1};
  sensor.modulation = {29e6, 31e6};
  calibration_.with.reset();
  EXPECT_NO_THROW(calibrated(sensor, calibration_));
  calibration_.fixed_pattern.pop_back();
  EXPECT_THROW(calibrated(sensor, calibration_), InputError);
  calibration_.fixed_pattern = some_pattern(2);
  calibration_.fixed_pattern[1] = calibration_.fixed_pattern[1].transpose().eval();
  EXPECT_THROW(calibrated(sensor, calibration_), InputError);
}

/// A frame whose ranges cover the cycle of each frequency, with the pattern added if there is one.
Frame frame_with(const FixedPattern& pattern, const Modulation& modulation) {
  Frame frame = blank_frame(modulation.count());
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    frame.phases[f].resize(3, 4);
    for (int i = 0; i < 12; ++i) {
      const float error_m = pattern.empty() ? 0.0F : pattern[f].data()[i];
      const double cycles =
          i / 12.0 + (std::isnan(error_m) ? 0 : error_m) / modulation.wavelength_m(f);
      frame.phases[f].data()[i] = static_cast<float>(cycles - std::floor(cycles));
    }
  }
  frame.phases[0](2, 0) = nan;
  return frame;
}

/// Rounding of phases, which are below 1, to floats: at most three times half of 2^-24.
constexpr float rounding_cycles = 1e-7F;

TEST(FixedPattern, IsUndoneExactly) {
  for (const Modulation& modulation :
       {Modulation{29e6}, Modulation{29e6, 31e6}, Modulation{80e6, 16e6, 120e6}}) {
    const FixedPattern pattern = some_pattern(modulation.count());
    const Frame plain = frame_with({}, modulation);
    Frame frame = frame_with(pattern, modulation);
    subtract_fixed_pattern(frame, modulation, pattern);
    EXPECT_TRUE(std::isnan(frame.phases[0](2, 0)));
    for (std::size_t f = 0; f < modulation.count(); ++f) {
      const ImageF off = frame.phases[f] - plain.phases[f];
      for (const float cycles : off.reshaped<Eigen::AutoOrder>()) {
        if (std::isnan(cycles)) continue;
        EXPECT_NEAR(cycles - std::round(cycles), 0, rounding_cycles);
      }
      EXPECT_FALSE((frame.phases[f] < 0).any());
      EXPECT_FALSE((frame.phases[f] >= 1).any());
    }
  }
}

TEST(FixedPattern, IsSubtractedBeforeTheErrorThatDependsOnThePhase) {
  const Modulation modulation{29e6, 31e6};
  CameraCalibration calibration;
  calibration.errors = {{.offset_m = 0.02, .harmonics = {{4, 0.01, -0.02}}}, {.offset_m = -0.01}};
  Frame without = frame_with({}, modulation);
  calibrate(without, modulation, calibration);
  calibration.fixed_pattern = some_pattern(2);
  Frame with = frame_with(calibration.fixed_pattern, modulation);
  calibrate(with, modulation, calibration);
  for (std::size_t f = 0; f < 2; ++f) {
    const ImageF off = with.phases[f] - without.phases[f];
    for (const float cycles : off.reshaped<Eigen::AutoOrder>()) {
      if (std::isnan(cycles)) continue;
      // The error rises by up to 0.1 of the phase, and adds its own rounding.
      EXPECT_NEAR(cycles - std::round(cycles), 0, 3 * rounding_cycles);
    }
  }
}

TEST(FixedPattern, LeavesPhasesBelowOneWhereRoundingWouldGiveOne) {
  Frame frame = blank_frame(1);
  frame.phases[0] = ImageF::Constant(1, 1, 0);
  subtract_fixed_pattern(frame, {29e6}, {ImageF::Constant(1, 1, 1e-9F)});
  EXPECT_EQ(frame.phases[0](0, 0), 0);
}

}  // namespace
}  // namespace tofmap
