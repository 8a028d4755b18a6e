// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/sample_frames.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

std::filesystem::path write_sample(const std::filesystem::path& folder, int frames) {
  SequenceWriter writer(folder, test::sample_sensor());
  for (int i = 0; i < frames; ++i) {
    writer.add(test::sample_frame(i), test::sample_pose(i), test::sample_range_truth());
  }
  return folder;
}

TEST(Sequence, ReadsBackTheSensorToTheBit) {
  const test::TemporaryFolder folder;
  const SequenceReader reader(write_sample(folder.path() / "seq", 1));
  const SensorModel expected = test::sample_sensor();
  const SensorModel& read = reader.sensor();
  EXPECT_EQ(read.camera.width_px, expected.camera.width_px);
  EXPECT_EQ(read.camera.height_px, expected.camera.height_px);
  EXPECT_EQ(read.camera.fx_px, expected.camera.fx_px);
  EXPECT_EQ(read.camera.fy_px, expected.camera.fy_px);
  EXPECT_EQ(read.camera.cx_px, expected.camera.cx_px);
  EXPECT_EQ(read.camera.cy_px, expected.camera.cy_px);
  EXPECT_EQ(read.camera.distortion, expected.camera.distortion);
  EXPECT_EQ(read.modulation.frequencies_hz[0], expected.modulation.frequencies_hz[0]);
  EXPECT_EQ(read.modulation.frequencies_hz[1], expected.modulation.frequencies_hz[1]);
  EXPECT_EQ(read.max_range_m, expected.max_range_m);
}

TEST(Sequence, ReadsBackEveryFrameToTheBit) {
  const test::TemporaryFolder folder;
  SequenceReader reader(write_sample(folder.path() / "seq", 3));
  ASSERT_EQ(reader.frame_count(), 3);
  for (int i = 0; i < 3; ++i) {
    const Frame expected = test::sample_frame(i);
    const auto sourced = reader.next();
    ASSERT_TRUE(sourced && sourced->frame) << (sourced ? sourced->damage : "no frame");
    EXPECT_EQ(sourced->index, i);
    EXPECT_EQ(sourced->frame->index, i);
    EXPECT_NEAR(sourced->timestamp_s, expected.timestamp_s, 5.1e-7);  // six decimals
    EXPECT_TRUE(same_values(sourced->frame->phases[0], expected.phases[0]));
    EXPECT_TRUE(same_values(sourced->frame->phases[1], expected.phases[1]));
    EXPECT_TRUE(same_values(sourced->frame->amplitudes[0], expected.amplitudes[0]));
    EXPECT_TRUE(same_values(sourced->frame->amplitudes[1], expected.amplitudes[1]));
  }
  EXPECT_FALSE(reader.next());
}

TEST(Sequence, ReadsBackTheTruth) {
  const test::TemporaryFolder folder;
  const SequenceReader reader(write_sample(folder.path() / "seq", 2));
  const Trajectory poses = reader.ground_truth();
  ASSERT_EQ(poses.size(), 2U);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(poses[i].timestamp_s, reader.files()[i].timestamp_s);
    EXPECT_TRUE(poses[i].world_from_camera.isApprox(test::sample_pose(i), 1e-8));  // 9 decimals
    const auto range_m = reader.range_truth(i);
    ASSERT_TRUE(range_m);
    EXPECT_TRUE(same_values(*range_m, test::sample_range_truth()));
  }
}

TEST(Sequence, IsReadableAfterEveryFrameThatWasWritten) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", test::sample_sensor());
  for (int i = 0; i < 2; ++i) {
    writer.add(test::sample_frame(i), test::sample_pose(i));
    const SequenceReader reader(folder.path() / "seq");
    EXPECT_EQ(reader.frame_count(), i + 1);
    EXPECT_TRUE(reader.read(i).frame) << reader.read(i).damage;
    EXPECT_EQ(reader.ground_truth().size(), i + 1U);
  }
}

TEST(Sequence, WithoutTruthHasNone) {
  const test::TemporaryFolder folder;
  SequenceWriter(folder.path(), test::sample_sensor()).add(test::sample_frame(0));
  const SequenceReader reader(folder.path());
  EXPECT_TRUE(reader.ground_truth().empty());
  EXPECT_FALSE(reader.range_truth(0));
}

TEST(Sequence, WithoutAmplitudesReadsBackWithoutAmplitudes) {
  const test::TemporaryFolder folder;
  Frame frame = test::sample_frame(0);
  frame.amplitudes[0].resize(0, 0);
  frame.amplitudes[1].resize(0, 0);
  SequenceWriter(folder.path(), test::sample_sensor()).add(frame);
  const SequenceReader reader(folder.path());
  const SourcedFrame read = reader.read(0);
  ASSERT_TRUE(read.frame) << read.damage;
  EXPECT_FALSE(read.frame->has_amplitude());
  EXPECT_TRUE(same_values(read.frame->phases[0], frame.phases[0]));
}

TEST(Sequence, WithOneAmplitudeOnlyCountsAsWithoutAmplitudes) {
  const test::TemporaryFolder folder;
  write_sample(folder.path() / "seq", 1);
  std::ofstream(folder.path() / "seq/frames.txt")
      << "0 phase_a/000000.png phase_b/000000.png amplitude_a/000000.png -\n"
      << "1 phase_a/000000.png phase_b/000000.png amplitude_a/000000.png\n"
      << "2 phase_a/000000.png phase_b/000000.png\n";
  const SequenceReader reader(folder.path() / "seq");
  for (int i = 0; i < 3; ++i) {
    const SourcedFrame read = reader.read(i);
    ASSERT_TRUE(read.frame) << read.damage;
    EXPECT_FALSE(read.frame->has_amplitude());
  }
}

TEST(Sequence, AmplitudeZeroMeansNoReturnAtThatFrequency) {
  const test::TemporaryFolder folder;
  write_sample(folder.path() / "seq", 1);
  ImageU16 dark = ImageU16::Constant(5, 7, 100);
  dark(4, 6) = 0;
  write_png(folder.path() / "seq/amplitude_a/000000.png", dark);
  const SequenceReader reader(folder.path() / "seq");
  const SourcedFrame read = reader.read(0);
  ASSERT_TRUE(read.frame) << read.damage;
  EXPECT_TRUE(std::isnan(read.frame->phases[0](4, 6)));
  EXPECT_FALSE(std::isnan(read.frame->phases[1](4, 6)));
}

TEST(Sequence, ListMayHoldCommentsBlankLinesAndWindowsLineEnds) {
  const test::TemporaryFolder folder;
  write_sample(folder.path() / "seq", 1);
  std::ofstream(folder.path() / "seq/frames.txt", std::ios::binary)
      << "# a comment\r\n\r\n   \n  # another\n"
      << "0.5\tphase_a/000000.png  phase_b/000000.png - -\r\n";
  const SequenceReader reader(folder.path() / "seq");
  ASSERT_EQ(reader.frame_count(), 1);
  EXPECT_TRUE(reader.read(0).frame) << reader.read(0).damage;
}

TEST(Sequence, AcceptsALongerWavelengthAtB) {
  const test::TemporaryFolder folder;
  SensorModel sensor = test::sample_sensor();
  std::swap(sensor.modulation.frequencies_hz[0], sensor.modulation.frequencies_hz[1]);
  SequenceWriter(folder.path(), sensor).add(test::sample_frame(0));
  const SequenceReader reader(folder.path());
  EXPECT_LT(reader.sensor().modulation.wavelength_m(0), reader.sensor().modulation.wavelength_m(1));
}

TEST(SequenceWriter, RoundsPhasesToTheNearestStepOfTheCircle) {
  const test::TemporaryFolder folder;
  Frame frame = test::sample_frame(0);
  frame.phases[0].setConstant(0.25F);
  frame.phases[0](0, 0) = std::nextafter(1.0F, 0.0F);  // nearest is a whole cycle, not 'no return'
  frame.amplitudes[0].setConstant(1);
  SequenceWriter(folder.path(), test::sample_sensor()).add(frame);
  const ImageU16 pixels = read_png_16(folder.path() / "phase_a/000000.png");
  EXPECT_EQ(pixels(0, 0), 0);
  EXPECT_EQ(pixels(1, 1), 16384);
}

TEST(SequenceWriter, NeverWritesAWeakReturnAsNone) {
  const test::TemporaryFolder folder;
  Frame frame = test::sample_frame(0);
  frame.amplitudes[0].setConstant(1e-3F);
  frame.amplitudes[1].setConstant(100.0F);
  SequenceWriter(folder.path(), test::sample_sensor(), 0.5).add(frame);
  EXPECT_EQ(read_png_16(folder.path() / "amplitude_a/000000.png")(0, 0), 1);
  EXPECT_EQ(read_png_16(folder.path() / "amplitude_b/000000.png")(0, 0), 50);
}

TEST(SequenceWriter, RefusesWhatDoesNotFit) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path(), test::sample_sensor());
  const auto refused = [&](const auto& change) {
    Frame frame = test::sample_frame(0);
    change(frame);
    EXPECT_THROW(writer.add(frame), UsageError);
  };
  refused([](Frame& frame) { frame.phases[0](2, 2) = 1.0F; });
  refused([](Frame& frame) { frame.phases[1](2, 2) = -0.1F; });
  refused([](Frame& frame) { frame.amplitudes[1](2, 2) = -1.0F; });
  refused([](Frame& frame) { frame.phases[0].resize(5, 6); });
  EXPECT_EQ(writer.count(), 0);
}

TEST(SequenceWriter, WritesATrueRangeThatDoesNotFitAsUnknown) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", test::sample_sensor());
  ImageF truth_m = test::sample_range_truth();
  truth_m.row(0) << 65.6F, 1e9F, -1.0F, 0.0004F, 65.535F, 0.0006F, 3.0F;
  writer.add(test::sample_frame(0), {}, truth_m);
  const ImageF back_m = *SequenceReader(folder.path() / "seq").range_truth(0);
  for (const int column : {0, 1, 2, 3}) EXPECT_TRUE(std::isnan(back_m(0, column))) << column;
  for (const int column : {4, 5, 6}) {
    EXPECT_NEAR(back_m(0, column), truth_m(0, column), 0.000501) << column;
  }
}

TEST(SequenceWriter, WritesAnAmplitudeBeyondTheScaleAsItsEnd) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", test::sample_sensor());
  Frame frame = test::sample_frame(0);
  frame.amplitudes[0](2, 2) = 1e6F;
  writer.add(frame);
  const SequenceReader reader(folder.path() / "seq");
  EXPECT_EQ(reader.read(0).frame->amplitudes[0](2, 2), reader.sensor().saturation_amplitude);
}

TEST(SequenceWriter, RefusesTimesThatDoNotAdvance) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path(), test::sample_sensor());
  writer.add(test::sample_frame(1));
  EXPECT_THROW(writer.add(test::sample_frame(1)), UsageError);
  EXPECT_THROW(writer.add(test::sample_frame(0)), UsageError);
}

TEST(SequenceWriter, RefusesAFolderThatHoldsSomethingOrCannotBeMade) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "letter.txt") << "mine\n";
  EXPECT_THROW(SequenceWriter(folder.path(), test::sample_sensor()), InputError);
  EXPECT_THROW(SequenceWriter(folder.path() / "letter.txt", test::sample_sensor()), InputError);
  EXPECT_THROW(SequenceWriter("/proc/seq", test::sample_sensor()), InputError);
}

TEST(SequenceWriter, NamesTheFileThatCannotBeWritten) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", test::sample_sensor());
  std::filesystem::create_symlink("/dev/full", folder.path() / "seq/phase_b/000000.png");
  try {
    writer.add(test::sample_frame(0));
    FAIL() << "written to a full disk";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("phase_b/000000.png"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(SequenceReader(folder.path() / "seq"), InputError) << "lists the unfinished frame";
}

/// A sensor and a frame with this number of frequencies.
SensorModel sensor_of(std::size_t frequencies) {
  SensorModel sensor = test::sample_sensor();
  sensor.modulation = {};
  for (std::size_t f = 0; f < frequencies; ++f) {
    sensor.modulation.frequencies_hz.push_back(80e6 - 8.5e6 * static_cast<double>(f));
    sensor.modulation.exposure_offsets_s.push_back(0.004 * static_cast<double>(f));
  }
  return sensor;
}

Frame frame_of(std::size_t frequencies) {
  const Frame pair = test::sample_frame(0);
  Frame frame = pair;
  frame.phases.clear();
  frame.amplitudes.clear();
  for (std::size_t f = 0; f < frequencies; ++f) {
    frame.phases.push_back(pair.phases[f % 2]);
    frame.amplitudes.push_back(pair.amplitudes[f % 2] / (1 + static_cast<float>(f)));
    frame.amplitudes.back() = frame.amplitudes.back().round();
  }
  return frame;
}

class AnyNumber : public testing::TestWithParam<std::size_t> {};

TEST_P(AnyNumber, OfFrequenciesReadsBackToTheBit) {
  const std::size_t count = GetParam();
  const test::TemporaryFolder folder;
  SequenceWriter(folder.path() / "seq", sensor_of(count)).add(frame_of(count));
  const SequenceReader reader(folder.path() / "seq");
  EXPECT_EQ(reader.sensor().modulation.frequencies_hz, sensor_of(count).modulation.frequencies_hz);
  if (count != 2) {  // version 1 has no times of exposure
    EXPECT_EQ(reader.sensor().modulation, sensor_of(count).modulation);
  }
  const SourcedFrame read = reader.read(0);
  ASSERT_TRUE(read.frame) << read.damage;
  const Frame expected = frame_of(count);
  ASSERT_EQ(read.frame->frequencies(), count);
  ASSERT_EQ(read.frame->amplitudes.size(), count);
  for (std::size_t f = 0; f < count; ++f) {
    const ImageF lit = (expected.amplitudes[f] == 0).select(NAN, expected.phases[f]);
    EXPECT_TRUE(same_values(read.frame->phases[f], lit)) << f;
    EXPECT_TRUE(same_values(read.frame->amplitudes[f], expected.amplitudes[f])) << f;
  }
}

INSTANTIATE_TEST_SUITE_P(Frequencies, AnyNumber, testing::Values(1, 2, 3, 8));

TEST(Sequence, OfThreeFrequenciesHasADamagedFrameWhereOneImageIsMissing) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", sensor_of(3));
  for (int i = 0; i < 3; ++i) {
    Frame frame = frame_of(3);
    frame.timestamp_s += i;
    writer.add(frame);
  }
  std::filesystem::remove(folder.path() / "seq" / "phase_c" / "000001.png");
  const SequenceReader reader(folder.path() / "seq");
  EXPECT_TRUE(reader.read(0).frame);
  EXPECT_FALSE(reader.read(1).frame);
  EXPECT_NE(reader.read(1).damage.find("phase_c/000001.png"), std::string::npos);
}

TEST(SequenceWriter, RefusesAFrameOfAnotherNumberOfFrequencies) {
  const test::TemporaryFolder folder;
  SequenceWriter writer(folder.path() / "seq", sensor_of(3));
  EXPECT_THROW(writer.add(frame_of(2)), UsageError);
}

}  // namespace
}  // namespace tofmap
