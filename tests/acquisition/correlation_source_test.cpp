// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/correlation_arrays.hpp>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/correlation/correlation_source.hpp>
#include <tofmap/acquisition/sequence.hpp>

namespace tofmap {
namespace {

constexpr int rows = 20;
constexpr int cols = 200;
constexpr int pixels = rows * cols;

/// One frame of 200 x 20 pixels with noise, from which noise can be estimated. The third step of
/// pixels 10 to 59 is off, pixel 100 is saturated, pixel 200 is not a number.
class CorrelationFrames : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  CorrelationSource source(const std::string& more = "", bool keep_inconsistent = false) const {
    std::vector<float> numbers;
    for (int k = 0; k < 4; ++k) {
      for (int n = 0; n < pixels; ++n) {
        const double noise = 7 * std::sin(12345.678 * (n + 1) * (k + 2));
        const bool is_off = k == 2 && n >= 10 && n < 60;
        numbers.push_back(static_cast<float>(1000 +
                                             300 * std::cos(0.01 * n - k * std::numbers::pi / 2) +
                                             noise + (is_off ? 80 : 0)));
      }
    }
    numbers[pixels + 100] = 4095;
    numbers[200] = nan;
    test::write_bytes(path("a.npy"), test::npy("<f4", "(1, 4, 20, 200)", test::bytes_of(numbers)));
    std::ofstream(path("a.yaml"))
        << "format: tofmap-correlation\nversion: 1\n"
        << "camera: {width: 200, height: 20, fx: 200, fy: 200, cx: 100, cy: 10}\n"
        << "frequencies_hz: [20.0e6]\nstep_angles_deg: [0, 90, 180, 270]\nphase_sign: 1\n"
        << "steps: single_ended\n"
        << "data: {files: a.npy, axes: [frame, step, row, column]}\n"
        << more;
    return CorrelationSource(CorrelationReader(read_correlation_description(path("a.yaml"))),
                             keep_inconsistent);
  }

  test::TemporaryFolder folder_;
};

const std::string saturation = "values: {saturation: {from: 4095}}\n";

TEST_F(CorrelationFrames, HaveNoPhaseWhereTheStepsContradictEachOther) {
  CorrelationSource frames = source(saturation);
  const Frame frame = *frames.next()->frame;
  EXPECT_FALSE(frames.next());
  const auto missing = frame.phases[0].isNaN();
  EXPECT_TRUE(missing.row(0).segment(10, 50).all());
  EXPECT_EQ(missing.count(), 51);  // and the pixel that is not a number
  EXPECT_EQ(frames.inconsistent_pixels(), 50);
}

TEST_F(CorrelationFrames, KeepPhasesThatContradictEachOtherIfAskedTo) {
  CorrelationSource frames = source(saturation, true);
  EXPECT_EQ(frames.next()->frame->phases[0].isNaN().count(), 1);
  EXPECT_EQ(frames.inconsistent_pixels(), 50);
}

TEST_F(CorrelationFrames, AreSaturatedWhereAStepIs) {
  CorrelationSource frames = source(saturation);
  const Frame frame = *frames.next()->frame;
  EXPECT_EQ(frame.amplitudes[0](0, 100), frames.sensor().saturation_amplitude);
  EXPECT_FALSE(std::isnan(frame.phases[0](0, 100)));
  EXPECT_EQ((frame.amplitudes[0] >= 65535).count(), 1);
}

TEST_F(CorrelationFrames, HaveAScaleThatFollowsFromTheDescription) {
  // √2 · 4095 = 5791 fits 11.3 times into 65534, and √2 · 2^8 181 times.
  EXPECT_EQ(source(saturation).amplitude_scale(), 8);
  EXPECT_EQ(source("amplitude: {max: 1000}\n").amplitude_scale(), 64);
  CorrelationSource frames = source(saturation);
  EXPECT_NEAR(frames.next()->frame->amplitudes[0](10, 10), 8 * 300, 8 * 8);
}

TEST_F(CorrelationFrames, HaveAScaleThatFollowsFromTheFirstOneIfValuesAreNotLimited) {
  // The largest amplitude is about 3095 / 2.
  const double scale = source().amplitude_scale();
  EXPECT_EQ(scale, 8);
}

TEST_F(CorrelationFrames, CanBeWrittenAsASequence) {
  CorrelationSource frames = source(saturation);
  SequenceWriter writer(path("sequence"), frames.sensor());
  writer.add(*frames.next()->frame);
  const Frame read = *SequenceReader(path("sequence")).read(0).frame;
  EXPECT_EQ(read.phases[0].isNaN().count(), 51);
  EXPECT_EQ((read.amplitudes[0] >= 65535).count(), 1);
  EXPECT_EQ(read.amplitudes[0](1, 0), 0);  // the pixel that is not a number
}

}  // namespace
}  // namespace tofmap
