// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What one pixel, line, image or name does to the work of the rest: nothing.

#include "program.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LostWork : public WithRecording {
 protected:
  /// Makes a pixel of the first row of frame 1 measure a range at both frequencies.
  void put_range(int column, double range_m) const {
    const Modulation modulation = SequenceReader(sequence_).sensor().modulation;
    put_phase("phase_a", column, range_m / modulation.wavelength_m(0));
    put_phase("phase_b", column, range_m / modulation.wavelength_m(1));
  }

  void put_phase(const std::string& kind, int column, double wavelengths) const {
    const fs::path file = sequence_ / kind / "000001.png";
    ImageU16 image = read_png_16(file);
    image(0, column) =
        static_cast<std::uint16_t>(std::lround(65535 * (wavelengths - std::floor(wavelengths))));
    write_png(file, image);
  }
};

TEST_F(LostWork, OfARangeThatDoesNotFitIsThatPixelAlone) {
  put_range(0, 70);  // beyond 16 bits of millimetres
  put_range(1, 0);   // would be written as 0, which means invalid
  const Finished finished = run("unwrap", {"--method", "pixel", "--set", "unwrap.max_range_m=74"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  const auto report = read_json(out_ / "report.json");
  const int dropped = report["frames"][1]["out_of_range_pixels"];
  EXPECT_GE(dropped, 2);
  EXPECT_GE(report["summary"]["out_of_range_pixels"], dropped);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("had ranges outside the 0.001 m to 65.535 m that images can store"),
                    HasSubstr("unwrap.max_range_m")));
  const ImageU8 reason = read_png_8(out_ / "reason" / "000001.png");
  const ImageU16 range = read_png_16(out_ / "range" / "000001.png");
  const ImageU8 wraps = read_png_8(out_ / "wraps" / "000001.png");
  const ImageU16 confidence = read_png_16(out_ / "confidence" / "000001.png");
  const auto out_of_range = static_cast<std::uint8_t>(InvalidReason::out_of_range);
  for (const int column : {0, 1}) {
    EXPECT_EQ(reason(0, column), out_of_range) << column;
    EXPECT_EQ(range(0, column), 0) << column;
    EXPECT_EQ(wraps(0, column), 255) << column;
    EXPECT_EQ(confidence(0, column), 0) << column;
  }
  EXPECT_EQ((reason == out_of_range).count(), dropped);
  EXPECT_EQ((reason == 0).count(), report["frames"][1]["valid_pixels"]);
}

TEST_F(LostWork, OfRangesThatFitIsNotSpokenOf) {
  const Finished finished = run("unwrap");
  EXPECT_THAT(finished.err, Not(HasSubstr("65.535")));
  EXPECT_EQ(read_json(out_ / "report.json")["summary"]["out_of_range_pixels"], 0);
}

TEST_F(LostWork, OfANameThatIsNotUtf8IsNone) {
  const fs::path odd = folder_.path() / "rec\xff";
  fs::rename(sequence_, odd);
  fs::rename(odd / "phase_a" / "000001.png", odd / "phase_a" / "one\xfe.png");
  std::string list = read_text(odd / "frames.txt");
  list.replace(list.find("phase_a/000001.png"), 18, "phase_a/one\xfe.png");
  std::ofstream(odd / "frames.txt") << list;
  fs::resize_file(odd / "phase_a" / "one\xfe.png", 50);
  for (const std::string command : {"unwrap", "map", "evaluate"}) {
    const Finished finished =
        run_program({command, odd.string(), "--out", out_.string(), "--set", "pictures.frames=1"});
    EXPECT_EQ(finished.status, 0) << command << finished.err;
    EXPECT_NO_THROW(read_json(out_ / "report.json")) << command;
    if (command == "unwrap") continue;
    EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr("rec\xEF\xBF\xBD")) << command;
  }
  EXPECT_EQ(run_program({"info", odd.string()}).status, 0);
}

TEST_F(LostWork, OfALineOfTheListThatIsNotUnderstoodIsThatFrameAlone) {
  edit("frames.txt", "0.066667 phase_a/000001.png", "noon phase_a/000001.png");
  for (const std::string command : {"info", "unwrap", "map", "evaluate"}) {
    EXPECT_EQ(run(command).status, 0) << command;
    if (command == "info" || command == "evaluate") continue;
    const auto report = read_json(out_ / "report.json");
    EXPECT_EQ(report["summary"]["damaged"], 1) << command;
    EXPECT_THAT(report["frames"][1]["damage"], HasSubstr("frames.txt:3: the timestamp 'noon'"));
    EXPECT_FALSE(report["frames"][2].contains("damage"));
  }
}

TEST_F(LostWork, OfTwoImagesOfOneNameIsNone) {
  fs::rename(sequence_ / "phase_a" / "000001.png", sequence_ / "phase_b" / "x.png");
  fs::create_directory(sequence_ / "more");
  fs::rename(sequence_ / "phase_b" / "x.png", sequence_ / "more" / "000000.png");
  edit("frames.txt", "phase_a/000001.png", "more/000000.png");
  ASSERT_EQ(run("unwrap").status, 0);
  EXPECT_EQ(names_in(out_ / "range"), (std::vector<std::string>{"000000.png", "000000_frame_1.png",
                                                                "000002.png", "000003.png"}));
  EXPECT_EQ(read_json(out_ / "report.json")["frames"][1]["image"], "000000_frame_1.png");
}

class DamagedTruth : public WithRecording {
 protected:
  void damage_poses() const {
    std::ofstream(sequence_ / "groundtruth.txt") << "0 0 0 0 0 0 0 1\nno pose\n";
  }

  void damage_ranges() const {
    for (const std::string& name : names_in(sequence_ / "range_truth")) {
      fs::resize_file(sequence_ / "range_truth" / name, 60);
    }
  }

  void expect_remark(const std::string& command, const std::string& remark) const {
    const Finished finished = run(command);
    ASSERT_EQ(finished.status, 0) << command << finished.err;
    EXPECT_THAT(command == "info" ? finished.out : finished.err, HasSubstr(remark)) << command;
    if (command == "info") return;
    EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr(remark)) << command;
  }
};

TEST_F(DamagedTruth, OfPosesIsNamedAndCostsTheComparisonAlone) {
  damage_poses();
  for (const std::string command : {"info", "map", "evaluate"}) {
    expect_remark(command, "groundtruth.txt:2: expected");
  }
  const auto report = read_json(out_ / "report.json");
  EXPECT_THAT(report["truth_left_out"][0], HasSubstr("1 true pose is damaged and left out"));
  EXPECT_TRUE(report["unwrapping"]["joint"]["wrong_wrap_percent"].is_number());
}

TEST_F(DamagedTruth, WithTimesOfAnotherRecordingIsNamed) {
  std::ofstream(sequence_ / "groundtruth.txt") << "1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 1\n";
  for (const std::string command : {"info", "map", "evaluate"}) {
    expect_remark(command, "no true pose is within 0.02 s of any frame");
  }
}

TEST_F(DamagedTruth, OfOnePoseLeavesTheOthers) {
  std::ofstream(sequence_ / "groundtruth.txt", std::ios::app) << "0.5 1e39 0 0 0 0 0 1\n";
  ASSERT_EQ(run("evaluate").status, 0);
  const auto report = read_json(out_ / "report.json");
  EXPECT_TRUE(report["trajectory"]["joint"]["ate_rmse_m"].is_number());
  EXPECT_LT(report["map"]["joint"]["accuracy_m"], 0.1);
}

TEST_F(DamagedTruth, OfRangesIsNamedAndCostsTheComparisonAlone) {
  damage_ranges();
  for (const std::string command : {"info", "map", "evaluate"}) {
    expect_remark(command, "true range images are damaged and left out of all comparisons");
  }
  EXPECT_TRUE(read_json(out_ / "report.json")["trajectory"]["joint"]["ate_rmse_m"].is_number());
}

TEST_F(DamagedTruth, ThatIsAFolderIsNamed) {
  fs::remove(sequence_ / "groundtruth.txt");
  fs::create_directory(sequence_ / "groundtruth.txt");
  expect_remark("map", "groundtruth.txt: is a folder");
}

TEST_F(DamagedTruth, DoesNotEndACalibration) {
  fs::resize_file(sequence_ / "range_truth" / "000000.png", 60);
  const Finished finished = run_program(
      {"calibrate", sequence_.string(), "--out", (folder_.path() / "found.yaml").string()});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("1 true range image is damaged"));
}

TEST_F(DamagedTruth, OfANationalGridGivesTheFiguresOfALocalOne) {
  // A path that is long and bends, since a straight one fits any rotation about itself.
  fs::remove_all(sequence_);
  ASSERT_EQ(run_program({"simulate", "room", "--out", sequence_.string(), "--frames", "60", "--set",
                         "simulator.width_px=44", "--set", "simulator.height_px=36"})
                .status,
            0);
  const std::vector<std::string> down_to{"--set", "evaluation.methods=joint"};
  ASSERT_EQ(run("evaluate", down_to).status, 0);
  const auto local = read_json(out_ / "report.json");
  std::ofstream shifted(sequence_ / "shifted.txt");
  shifted.precision(16);
  std::ifstream poses(sequence_ / "groundtruth.txt");
  for (std::string line; std::getline(poses, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream in(line);
    std::string rest;
    double t = 0;
    double x = 0;
    double y = 0;
    double z = 0;
    in >> t >> x >> y >> z;
    std::getline(in, rest);
    shifted << t << ' ' << x + 5e6 << ' ' << y + 5e6 << ' ' << z - 5e6 << rest << '\n';
  }
  shifted.close();
  fs::rename(sequence_ / "shifted.txt", sequence_ / "groundtruth.txt");
  ASSERT_EQ(run("evaluate", down_to).status, 0);
  const auto far = read_json(out_ / "report.json");
  // Doubles of 5e6 m step by 1e-9 m, and the file's own digits are as coarse.
  for (const std::string key : {"ate_rmse_m", "ate_max_m"}) {
    EXPECT_NEAR(far["trajectory"]["joint"][key], local["trajectory"]["joint"][key], 1e-7) << key;
  }
  // Walls lie on borders of the reference's voxels, where 1e-9 m decides which point a voxel keeps.
  EXPECT_NEAR(far["map"]["joint"]["accuracy_m"], local["map"]["joint"]["accuracy_m"], 3e-5);
  EXPECT_NEAR(far["map"]["joint"]["completeness_percent"],
              local["map"]["joint"]["completeness_percent"], 0.1);
  EXPECT_EQ(run("map").status, 0);
}

/// A recording of the TUM benchmark, of which something is damaged.
class DamagedTum : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_.path() / "depth");
    std::ofstream list(folder_.path() / "depth.txt");
    std::ofstream poses(folder_.path() / "groundtruth.txt");
    for (int i = 0; i < 4; ++i) {
      const std::string name = "depth/" + std::to_string(i) + ".png";
      write_png(folder_.path() / name, ImageU16(ImageU16::Constant(48, 64, 20000)));
      list << i << ' ' << name << '\n';
      poses << i << " 0 0 0 0 0 0 1\n";
    }
  }

  Finished wrap() const {
    return run_program({"simulate", "--from-tum", folder_.path().string(), "--out", out_.string(),
                        "--set", "tum.fx_px=60", "--set", "tum.fy_px=60", "--set", "tum.cx_px=31.5",
                        "--set", "tum.cy_px=23.5"});
  }

  TemporaryFolder folder_;
  fs::path out_ = folder_.path() / "out";
};

TEST_F(DamagedTum, ByOneImageGivesTheOtherFrames) {
  fs::remove(folder_.path() / "depth" / "1.png");
  const Finished finished = wrap();
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("3 of 4 frames"));
  EXPECT_THAT(finished.err, HasSubstr("1.png"));
}

TEST_F(DamagedTum, ByAFirstImageOfAnotherSizeGivesTheOtherFrames) {
  write_png(folder_.path() / "depth" / "0.png", ImageU16(ImageU16::Constant(30, 64, 20000)));
  EXPECT_THAT(wrap().out, HasSubstr("3 of 4 frames"));
}

TEST_F(DamagedTum, ByALineGivesTheOtherFrames) {
  std::ofstream(folder_.path() / "depth.txt", std::ios::app) << "2 depth/2.png\nnonsense\n";
  std::ofstream(folder_.path() / "groundtruth.txt", std::ios::app) << "no pose\n";
  const Finished finished = wrap();
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("4 of 6 frames"));
  EXPECT_THAT(finished.err, AllOf(HasSubstr("depth.txt:5"), HasSubstr("groundtruth.txt:5")));
  EXPECT_EQ(SequenceReader(out_).ground_truth().size(), 4U);
}

}  // namespace
}  // namespace tofmap::test
