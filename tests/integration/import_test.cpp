// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Recordings of other programs, from their files to a sequence and to ranges.

#include "program.hpp"

#include <cmath>
#include <csignal>
#include <fstream>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <support/correlation_arrays.hpp>
#include <support/waiting.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A simulated recording of a Kinect v2, made once and copied for each test.
class Kinect2Import : public testing::Test {
 protected:
  static constexpr int frames = 3;

  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    simulated_ = run_program({"simulate", "room", "--format", "kinect2", "--out",
                              (made_->path() / "kinect").string(), "--frames",
                              std::to_string(frames), "--set", "simulator.subpixels=1"});
  }
  static void TearDownTestSuite() { made_.reset(); }

  void SetUp() override {
    ASSERT_EQ(simulated_.status, 0) << simulated_.err;
    fs::copy(made_->path() / "kinect", recording_, fs::copy_options::recursive);
  }

  Finished import(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"import", "kinect2", recording_.string(), "--out",
                                       out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  /// Expects status 3 and a message with both parts, and that nothing is left behind.
  void expect_refusal(const std::string& part, const std::string& other_part) const {
    const auto before = names_in(folder_.path());
    const Finished finished = import();
    EXPECT_EQ(finished.status, 3);
    EXPECT_THAT(finished.err, AllOf(HasSubstr(part), HasSubstr(other_part)));
    EXPECT_EQ(finished.out, "");
    EXPECT_EQ(names_in(folder_.path()), before);
  }

  fs::path packet(int index) const {
    return recording_ / "frames" / "depth" / ("000000000" + std::to_string(index) + ".depth");
  }

  /// Makes loose packets of the recording, without anything else.
  void keep_loose_packets() {
    const fs::path loose = folder_.path() / "loose";
    fs::create_directory(loose);
    for (int i = 0; i < frames; ++i) {
      fs::rename(packet(i), loose / ("dump_" + std::to_string(1000 + 267 * i) + "_" +
                                     std::to_string(i) + ".depth"));
    }
    fs::rename(recording_ / "calibration" / "p0.bin", folder_.path() / "p0.bin");
    recording_ = loose;
  }

  static std::unique_ptr<TemporaryFolder> made_;
  static Finished simulated_;
  TemporaryFolder folder_;
  fs::path recording_ = folder_.path() / "kinect";
  fs::path out_ = folder_.path() / "out";
};

std::unique_ptr<TemporaryFolder> Kinect2Import::made_;
Finished Kinect2Import::simulated_;

TEST_F(Kinect2Import, OfASimulatedRecordingIsUnwrappedToTheTrueRanges) {
  const Finished finished = import();
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("3 of 3 frames"), HasSubstr("saturated: "),
                                  Not(HasSubstr("warning"))));
  EXPECT_THAT(finished.err, Not(HasSubstr("warning")));
  const SequenceReader sequence(out_);
  EXPECT_EQ(sequence.sensor().modulation.frequencies_hz, (std::vector<double>{80e6, 16e6, 120e6}));
  EXPECT_EQ(sequence.ground_truth().size(), 3U);

  const fs::path ranges = folder_.path() / "ranges";
  const Finished unwrapped = run_program({"unwrap", out_.string(), "--out", ranges.string(),
                                          "--method", "pixel", "--set", "pictures.frames=0"});
  ASSERT_EQ(unwrapped.status, 0) << unwrapped.err;
  const ImageU16 range_mm = read_png_16(ranges / "range" / "000001.png");
  const ImageF truth_m = *sequence.range_truth(1);
  int seen = 0;
  int right = 0;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    if (range_mm.data()[i] == 0 || std::isnan(truth_m.data()[i])) continue;
    ++seen;
    right += std::abs(range_mm.data()[i] / 1000.0 - truth_m.data()[i]) < 0.1 ? 1 : 0;
  }
  EXPECT_GT(seen, 0.9 * 512 * 424);
  // As many as without packets: noise makes the others.
  EXPECT_GT(right, 0.95 * seen);
}

TEST_F(Kinect2Import, TakesTheTruthOfTheSceneAlong) {
  ASSERT_EQ(import().status, 0);
  for (const std::string file : {"scene.ply", "furniture.json"}) {
    EXPECT_NE(read_text(recording_ / file), "") << file;
    EXPECT_EQ(read_text(out_ / file), read_text(recording_ / file)) << file;
  }
}

TEST_F(Kinect2Import, OfSaturatedPixelsLeavesThemSaturated) {
  recording_ = folder_.path() / "near";
  std::ofstream(folder_.path() / "poses.txt") << "0 0 0 0 0 0 0 1\n";
  std::ofstream(folder_.path() / "near.obj")
      << "v -9 -9 0.2\nv 9 -9 0.2\nv 9 9 0.2\nv -9 9 0.2\nf 1 2 3 4\n";
  const Finished simulated = run_program(
      {"simulate", (folder_.path() / "near.obj").string(), "--format", "kinect2", "--out",
       recording_.string(), "--frames", "1", "--set", "simulator.subpixels=1", "--set",
       "simulator.trajectory_file=" + (folder_.path() / "poses.txt").string()});
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  ASSERT_EQ(import().status, 0);
  EXPECT_GT(read_json(out_ / "report.json")["saturated_pixels"], 1000);
  const fs::path ranges = folder_.path() / "ranges";
  ASSERT_EQ(run_program({"unwrap", out_.string(), "--out", ranges.string(), "--method", "pixel",
                         "--set", "pictures.frames=0"})
                .status,
            0);
  constexpr int saturated = 7;  // docs/filters.md
  EXPECT_EQ(read_png_8(ranges / "reason" / "000000.png")(212, 256), saturated);
}

TEST_F(Kinect2Import, OfLoosePacketsAssumesACameraAndSaysSo) {
  keep_loose_packets();
  const Finished finished = import({"--p0", (folder_.path() / "p0.bin").string()});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("warning: the recording has no intrinsics"),
                                  HasSubstr("docs/import-kinect2.md")));
  EXPECT_EQ(SequenceReader(out_).frame_count(), 3);
}

TEST_F(Kinect2Import, WithoutP0TablesSaysWhereTheyComeFrom) {
  keep_loose_packets();
  expect_refusal("p0.bin", "the camera's answer to the request for its P0 tables");
}

TEST_F(Kinect2Import, LeavesOutDamagedTruthAndNamesIt) {
  const fs::path damaged = recording_ / "range_truth" / "000001.png";
  fs::resize_file(damaged, fs::file_size(damaged) / 2);
  const Finished finished = import();
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("true ranges of 1 frame"), HasSubstr("000001.png")));
  EXPECT_EQ(SequenceReader(out_).frame_count(), 3);
  EXPECT_FALSE(SequenceReader(out_).range_truth(1));
  EXPECT_TRUE(SequenceReader(out_).range_truth(2));
}

TEST_F(Kinect2Import, LeavesOutADamagedPacketAndNamesIt) {
  fs::resize_file(packet(1), 1000);
  const Finished finished = import();
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("2 of 3 frames"));
  EXPECT_THAT(finished.err, AllOf(HasSubstr("1 frame left out"), HasSubstr("0000000001.depth")));
  const SequenceReader sequence(out_);
  EXPECT_EQ(sequence.frame_count(), 2);
  // Truth stays with its frame.
  EXPECT_NEAR((*sequence.range_truth(1))(212, 256),
              read_png_16(recording_ / "range_truth" / "000002.png")(212, 256) / 1000.0, 1e-4);
  EXPECT_EQ(read_json(out_ / "report.json")["left_out"].size(), 1U);
}

TEST_F(Kinect2Import, OfMostlyDamagedPacketsIsRefused) {
  fs::remove(packet(1));
  fs::resize_file(packet(0), 1000);
  expect_refusal("2 of 3 frames are damaged", ".depth");
}

TEST_F(Kinect2Import, OfAPathThatIsMissingIsRefused) {
  fs::remove_all(recording_);
  expect_refusal(recording_.string(), "no such folder");
}

TEST_F(Kinect2Import, OfAnEmptyFolderSaysWhatARecordingHolds) {
  fs::remove_all(recording_);
  fs::create_directory(recording_);
  expect_refusal("is no recording of a Kinect v2", "frames.ndjson");
}

TEST_F(Kinect2Import, OfASequenceIsRefused) {
  ASSERT_EQ(import().status, 0);
  fs::remove_all(recording_);
  fs::rename(out_, recording_);
  expect_refusal("is a sequence already", recording_.string());
}

TEST_F(Kinect2Import, DoesNotReplaceARecording) {
  ASSERT_EQ(import().status, 0);
  expect_refusal(out_.string(), "contains a recording");
  EXPECT_EQ(SequenceReader(out_).frame_count(), 3);
}

TEST_F(Kinect2Import, OfAResultFolderThatIsARecordingIsNotReplacedByResults) {
  const Finished finished =
      run_program({"import", "kinect2", recording_.string(), "--out", recording_.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("contains a recording"));
}

TEST_F(Kinect2Import, TakesNoArgumentsOfOtherFormats) {
  const Finished finished = import({"--keep-inconsistent"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("'tofmap import correlation'"));
}

TEST_F(Kinect2Import, OfAnUnknownFormatListsTheFormats) {
  const Finished finished =
      run_program({"import", "kinect3", recording_.string(), "--out", out_.string()});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("kinect3"), HasSubstr("kinect2,correlation")));
}

TEST_F(Kinect2Import, ThatIsInterruptedKeepsTheFramesSoFar) {
  // Many frames of the same few packets.
  std::ofstream journal(recording_ / "frames.ndjson");
  for (int i = 0; i < 500; ++i) {
    const std::string path = "frames/depth/" + std::to_string(100 + i) + ".depth";
    fs::create_hard_link(packet(i % frames), recording_ / path);
    journal << R"({"index":)" << i << R"(,"stream":"depth","path":")" << path
            << R"(","byte_count":2984960,"device_timestamp":)" << 267 * i << R"(,"sequence":)" << i
            << R"(,"arrival_offset_us":)" << 33375 * i << "}\n";
  }
  journal.close();
  RunningProgram program({"import", "kinect2", recording_.string(), "--out", out_.string()});
  ASSERT_TRUE(comes_true([&] {
    return program.has_ended() ||
           fs::exists(unfinished_result(folder_.path()) / "phase_a" / "000001.png");
  }));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  const int kept = *SequenceReader(out_).frame_count();
  EXPECT_GE(kept, 2);
  EXPECT_LT(kept, 500);
  EXPECT_EQ(read_json(out_ / "report.json")["interrupted"], true);
}

TEST(Kinect2Simulation, RefusesWhatAPacketCannotHold) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  for (const std::string wrong :
       {"simulator.width_px=176", "simulator.frequencies_hz=80e6, 100e6"}) {
    const Finished finished =
        run_program({"simulate", "wall", "--format", "kinect2", "--out", out, "--set", wrong});
    EXPECT_EQ(finished.status, 2) << wrong;
    EXPECT_THAT(finished.err, HasSubstr("a packet of a Kinect v2 holds")) << wrong;
    EXPECT_FALSE(fs::exists(out));
  }
}

/// Correlation images of a tilted wall, in one array.
class CorrelationImport : public testing::Test {
 protected:
  static constexpr int rows = 24;
  static constexpr int cols = 40;
  static constexpr double wavelength_m = 299792458.0 / 2 / 20e6;

  static double range_m(int row, int col) { return 2 + 0.02 * col + 0.01 * row; }

  void SetUp() override {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 2);
    std::vector<float> numbers;
    for (int frame = 0; frame < 3; ++frame) {
      for (int k = 0; k < 4; ++k) {
        for (int n = 0; n < rows * cols; ++n) {
          const double angle =
              2 * std::numbers::pi * (range_m(n / cols, n % cols) + 0.1 * frame) / wavelength_m -
              k * std::numbers::pi / 2;
          const double motion = k == 2 && n < 30 ? 200 : 0;
          const bool is_saturated = n == 100;
          numbers.push_back(static_cast<float>(
              is_saturated ? 4095 : 1000 + 300 * std::cos(angle) + noise(random) + motion));
        }
      }
    }
    write_bytes(folder_.path() / "a.npy", npy("<f4", "(3, 4, 24, 40)", bytes_of(numbers)));
    std::ofstream(description_)
        << "format: tofmap-correlation\nversion: 1\n"
        << "camera: {width: 40, height: 24, fx: 40, fy: 40, cx: 19.5, cy: 11.5}\n"
        << "frequencies_hz: [20.0e6]\nstep_angles_deg: [0, 90, 180, 270]\nphase_sign: 1\n"
        << "steps: single_ended\nvalues: {saturation: {from: 4095}}\n"
        << "data: {files: a.npy, axes: [frame, step, row, column]}\n";
  }

  Finished import(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"import", "correlation", description_.string(), "--out",
                                       out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  TemporaryFolder folder_;
  fs::path description_ = folder_.path() / "camera.yaml";
  fs::path out_ = folder_.path() / "out";
};

TEST_F(CorrelationImport, WritesPhasesAndSaysWhatIsWrongWithPixels) {
  const Finished finished = import();
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("3 of 3 frames"), HasSubstr("saturated: 0.10 %"),
                                  HasSubstr("inconsistent (motion or saturation): 3.1"),
                                  HasSubstr(" % of the pixels, without return")));
  const SequenceReader sequence(out_);
  const Frame frame = *sequence.read(1).frame;
  EXPECT_NEAR(frame.phases[0](10, 20), (range_m(10, 20) + 0.1) / wavelength_m, 0.003);
  EXPECT_TRUE(std::isnan(frame.phases[0](0, 5)));
  EXPECT_EQ(frame.amplitudes[0](2, 20), 65535);
}

TEST_F(CorrelationImport, KeepsInconsistentPixelsIfAskedTo) {
  const Finished finished = import({"--keep-inconsistent"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("of the pixels, kept"));
  EXPECT_FALSE(std::isnan((*SequenceReader(out_).read(1).frame).phases[0](0, 5)));
}

TEST_F(CorrelationImport, SaysWhenTheDescriptionIsNotThatOfTheData) {
  const std::string right = read_text(description_);
  EXPECT_THAT(import().out,
              AllOf(HasSubstr("residuals of the steps of A: "), Not(HasSubstr("warning"))));
  struct Wrong {
    std::string was;
    std::string is;
  };
  for (const auto& [was, is] : {Wrong{"[0, 90, 180, 270]", "[90, 0, 180, 270]"},
                                Wrong{"[0, 90, 180, 270]", "[0, 180, 90, 270]"}}) {
    std::string text = right;
    text.replace(text.find(was), was.size(), is);
    std::ofstream(description_) << text;
    fs::remove_all(out_);
    const Finished finished = import();
    EXPECT_EQ(finished.status, 0) << finished.err;
    EXPECT_THAT(finished.out, AllOf(HasSubstr("warning: the steps of A contradict each other by"),
                                    HasSubstr("step angles and their order")))
        << is;
    EXPECT_GT(read_json(out_ / "report.json")["relative_residuals"][0], 0.15);
  }
}

TEST_F(CorrelationImport, SaysWhenNoPixelHasAReturn) {
  std::ofstream(description_, std::ios::app) << "amplitude: {min: 1000}\n";
  EXPECT_THAT(import().out, HasSubstr("warning: 9"));
  EXPECT_GT(read_json(out_ / "report.json")["empty_pixels"], 2700);
}

TEST_F(CorrelationImport, OfASequenceIsRefused) {
  ASSERT_EQ(import().status, 0);
  const fs::path sequence = folder_.path() / "sequence";
  fs::rename(out_, sequence);
  for (const fs::path& path : {sequence, sequence / "sequence.yaml"}) {
    description_ = path;
    const Finished finished = import();
    EXPECT_EQ(finished.status, 3);
    EXPECT_THAT(finished.err, HasSubstr("is a sequence already"));
  }
}

TEST_F(CorrelationImport, OfAFolderOrAMissingFileIsRefused) {
  description_ = folder_.path();
  EXPECT_THAT(import().err, HasSubstr("give the YAML file"));
  description_ = folder_.path() / "missing.yaml";
  const Finished finished = import();
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("missing.yaml"));
}

TEST_F(CorrelationImport, TakesNoArgumentsOfOtherFormats) {
  const Finished finished = import({"--p0", "p0.bin"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("phase_offsets"));
}

}  // namespace
}  // namespace tofmap::test
