// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Each kind of bad recording, as a user meets it: exit status, message, what is left behind.

#include "program.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BadRecording : public WithRecording {
 protected:
  /// Expects that each command that reads a recording refuses it with status 3 and a message
  /// that holds both parts, and leaves nothing behind.
  void expect_refusal(const std::string& part, const std::string& other_part = "") const {
    for (const std::string command : {"info", "unwrap", "map", "evaluate"}) {
      expect_refusal_of(command, part, other_part);
    }
  }

  void expect_refusal_of(const std::string& command, const std::string& part,
                         const std::string& other_part = "") const {
    const auto before = names_in(folder_.path());
    const Finished finished = run(command);
    EXPECT_EQ(finished.status, 3) << command;
    EXPECT_THAT(finished.err, HasSubstr(part)) << command;
    EXPECT_THAT(finished.err, HasSubstr(other_part)) << command;
    EXPECT_EQ(finished.out, "") << command;
    EXPECT_EQ(names_in(folder_.path()), before) << command;
  }

  /// Expects that unwrap and map skip frame 1, name its damage in the report and keep the rest.
  void expect_frame_1_skipped(const std::string& damage) const {
    for (const std::string command : {"unwrap", "map"}) {
      const Finished finished = run(command);
      ASSERT_EQ(finished.status, 0) << command << finished.err;
      if (command == "unwrap") {
        EXPECT_THAT(finished.out,
                    HasSubstr(std::to_string(frames - 1) + " of " + std::to_string(frames) +
                              " frames unwrapped, 1 damaged"));
      }
      const auto report = read_json(out_ / "report.json");
      EXPECT_EQ(report["summary"]["damaged"], 1) << command;
      ASSERT_EQ(report["frames"].size(), frames) << command;
      EXPECT_THAT(report["frames"][1]["damage"], HasSubstr(damage)) << command;
      EXPECT_THAT(report["frames"][1]["damage"], HasSubstr("000001.png")) << command;
      EXPECT_FALSE(report["frames"][2].contains("damage")) << command;
      if (command == "map") {
        EXPECT_EQ(report["frames"][1]["map"], nullptr);
        EXPECT_EQ(report["frames"][2]["map"], 1);
        EXPECT_EQ(report["summary"]["missing"]["damaged"], 1);
        EXPECT_THAT(finished.out, HasSubstr("1 frame in no map, damaged: 1\n"));
        EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr(damage));
      }
    }
    const Finished info = run("info");
    EXPECT_EQ(info.status, 0);
    EXPECT_THAT(info.out, HasSubstr("damaged frames: 1"));
    EXPECT_THAT(info.out, HasSubstr(damage));
  }

  fs::path phase_a(int index) const {
    return sequence_ / "phase_a" / ("00000" + std::to_string(index) + ".png");
  }
};

TEST_F(BadRecording, FolderThatIsMissingIsNamed) {
  fs::remove_all(sequence_);
  expect_refusal(sequence_.string(), "no such folder");
}

TEST_F(BadRecording, WithoutHeaderTellsWhatASequenceHolds) {
  fs::remove(sequence_ / "sequence.yaml");
  expect_refusal("sequence.yaml", "frames.txt");
}

TEST_F(BadRecording, WithoutFramesIsRefused) {
  std::ofstream(sequence_ / "frames.txt") << "# nothing yet\n";
  expect_refusal("frames.txt", "no frames");
}

TEST_F(BadRecording, OfEqualFrequenciesIsRefusedWithTheReason) {
  edit("sequence.yaml", "3.1e+07", "2.9e+07");
  expect_refusal("are equal", "wraps can only be told apart by different frequencies");
}

TEST_F(BadRecording, WithTheLongerWavelengthAtBIsAccepted) {
  edit("sequence.yaml", "frequency_a_hz: 2.9e+07", "frequency_a_hz: 3.1e+07");
  edit("sequence.yaml", "frequency_b_hz: 3.1e+07", "frequency_b_hz: 2.9e+07");
  fs::rename(sequence_ / "phase_a", sequence_ / "phase");
  fs::rename(sequence_ / "phase_b", sequence_ / "phase_a");
  fs::rename(sequence_ / "phase", sequence_ / "phase_b");
  const Finished finished = run("unwrap");
  ASSERT_EQ(finished.status, 0) << finished.err;
  // The same room must come out: the wrong λ would put most pixels a wavelength off.
  const ImageU16 range = read_png_16(out_ / "range" / "000000.png");
  const ImageU16 truth = read_png_16(sequence_ / "range_truth" / "000000.png");
  int right = 0;
  int seen = 0;
  for (Eigen::Index i = 0; i < range.size(); ++i) {
    if (range.data()[i] == 0 || truth.data()[i] == 0) continue;
    ++seen;
    right += std::abs(int{range.data()[i]} - int{truth.data()[i]}) < 2400 ? 1 : 0;
  }
  EXPECT_GT(seen, 44 * 36 / 2);
  EXPECT_GT(right, 0.9 * seen);
}

TEST_F(BadRecording, WithoutAmplitudesIsUnwrappedAndMapped) {
  std::ofstream list(sequence_ / "frames.txt");
  for (int i = 0; i < frames; ++i) {
    const std::string name = "/00000" + std::to_string(i) + ".png";
    list << i / 15.0 << " phase_a" << name << " phase_b" << name << " - -\n";
  }
  list.close();
  for (const std::string command : {"unwrap", "map"}) {
    const Finished finished = run(command);
    EXPECT_EQ(finished.status, 0) << command << finished.err;
  }
  EXPECT_THAT(run("info").out, HasSubstr("frames without amplitudes: 4"));
}

TEST_F(BadRecording, WithoutAnyReturnIsUnwrappedButNotMapped) {
  constexpr std::uint16_t no_return = 65535;
  for (int i = 0; i < frames; ++i)
    write_png(phase_a(i), ImageU16(ImageU16::Constant(36, 44, no_return)));
  EXPECT_EQ(run("unwrap").status, 0);
  expect_refusal_of("map", "is the camera covered");
  EXPECT_THAT(run("info").out, HasSubstr("warning: no pixel has a return"));

  const Finished evaluated = run("evaluate");
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["map"]["jump"]["points"], 0);
  EXPECT_TRUE(report["unwrapping"]["jump"]["range_rmse_m"].is_null());
}

TEST_F(BadRecording, OfOneFrameIsMapped) {
  std::ofstream(sequence_ / "frames.txt")
      << "0 phase_a/000000.png phase_b/000000.png amplitude_a/000000.png amplitude_b/000000.png\n";
  const Finished finished = run("map", {"--set", "map.min_observations=1"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("1 of 1 frames registered"));
  EXPECT_EQ(run("evaluate").status, 0);
}

TEST_F(BadRecording, OfIdenticalFramesCountsAsOneFrame) {
  for (int i = 1; i < frames; ++i) {
    for (const std::string kind : {"phase_a", "phase_b", "amplitude_a", "amplitude_b"}) {
      fs::copy_file(sequence_ / kind / "000000.png",
                    sequence_ / kind / ("00000" + std::to_string(i) + ".png"),
                    fs::copy_options::overwrite_existing);
    }
  }
  const Finished finished = run("map");
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("warning: 3 frames repeat the previous frame"));
  EXPECT_EQ(read_trajectory(out_ / "trajectory.txt").size(), 1U);
}

TEST_F(BadRecording, ThatStandsStillForAWhileGetsAWarning) {
  for (const std::string kind : {"phase_a", "phase_b"}) {
    fs::copy_file(sequence_ / kind / "000002.png", sequence_ / kind / "000003.png",
                  fs::copy_options::overwrite_existing);
  }
  const Finished finished = run("map");
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("warning: 1 frame repeats the previous frame"));
  EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr("1 frame repeats the previous frame"));
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["summary"]["repeated"], 1);
  EXPECT_FALSE(report["frames"][2].contains("repeats"));
  EXPECT_EQ(report["frames"][3]["repeats"], true);
  EXPECT_EQ(report["frames"][3]["map"], nullptr);
}

TEST_F(BadRecording, WithTimesInMillisecondsGetsAWarning) {
  std::istringstream list(read_text(sequence_ / "frames.txt"));
  std::ofstream changed(sequence_ / "frames.txt");
  double time_s = 0;
  std::string files;
  std::getline(list, files);  // the names of the columns
  while (list >> time_s && std::getline(list, files)) changed << 1000 * time_s << files << '\n';
  changed.close();
  ASSERT_EQ(run("map").status, 0);
  EXPECT_THAT(read_json(out_ / "report.json")["warnings"],
              testing::Contains(HasSubstr("are their times in seconds?")));
}

TEST_F(BadRecording, WhoseFrequenciesCannotTellTheSceneApartGetsAWarning) {
  edit("sequence.yaml", "version: 1", "version: 1\nmax_range_m: 15.5");
  edit("sequence.yaml", "frequency_a_hz: 2.9e+07", "frequency_a_hz: 3.1e+08");
  EXPECT_THAT(run("info").out, HasSubstr("warning: the scene reaches farther"));
}

TEST_F(BadRecording, WithNothingSeenOftenEnoughSaysWhichOptionsToChange) {
  const Finished finished = run("map", {"--set", "map.min_observations=1000"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("map.min_observations"));
}

TEST_F(BadRecording, FrameCutShortIsSkippedAndNamed) {
  fs::resize_file(phase_a(1), fs::file_size(phase_a(1)) / 2);
  expect_frame_1_skipped("truncated");
}

TEST_F(BadRecording, FrameThatIsMissingIsSkippedAndNamed) {
  fs::remove(phase_a(1));
  expect_frame_1_skipped("cannot be read");
}

TEST_F(BadRecording, FrameOfWrongSizeIsSkippedAndNamed) {
  write_png(phase_a(1), ImageU16(ImageU16::Constant(36, 43, 7)));
  expect_frame_1_skipped(
      "is 43 x 36 pixels, but the camera of sequence.yaml has a width of 44 and a height of 36");
}

TEST_F(BadRecording, FrameOf8BitsIsSkippedAndNamed) {
  write_png(phase_a(1), ImageU8(ImageU8::Constant(36, 44, 7)));
  expect_frame_1_skipped("must be a gray PNG of 16 bits, but has 8 bits");
}

TEST_F(BadRecording, FrameThatIsAPipeIsNotWaitedFor) {
  fs::remove(phase_a(1));
  ASSERT_EQ(mkfifo(phase_a(1).c_str(), 0600), 0);
  expect_frame_1_skipped("is not a regular file");
}

TEST_F(BadRecording, WithAFolderInPlaceOfAFileIsNamed) {
  fs::remove(sequence_ / "sequence.yaml");
  fs::create_directory(sequence_ / "sequence.yaml");
  expect_refusal("sequence.yaml", "is a folder");
}

TEST_F(BadRecording, ThatIsAFileIsTold) {
  const Finished finished = run_program({"info", (sequence_ / "frames.txt").string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("is a file; give its folder"));
}

TEST_F(BadRecording, HalfDamagedIsStillMapped) {
  for (const int i : {1, 2}) fs::remove(phase_a(i));
  EXPECT_EQ(run("map").status, 0);
  EXPECT_EQ(run("unwrap").status, 0);
}

TEST_F(BadRecording, MoreThanHalfDamagedIsRefusedAndLeavesNothing) {
  for (const int i : {0, 1, 2}) fs::remove(phase_a(i));
  expect_refusal_of("unwrap", "3 of 4 frames are damaged", "000000.png");
  expect_refusal_of("map", "3 of 4 frames are damaged", "000000.png");
}

TEST_F(BadRecording, WithoutAnyReturnCannotBeMapped) {
  for (int i = 0; i < frames; ++i)
    write_png(phase_a(i), ImageU16(ImageU16::Constant(36, 44, 65535)));
  expect_refusal_of("map", "no frame has enough surface");
  // Images without a pixel are right ranges all the same.
  const Finished finished = run("unwrap");
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(read_png_16(out_ / "range" / "000000.png").maxCoeff(), 0);
}

}  // namespace
}  // namespace tofmap::test
