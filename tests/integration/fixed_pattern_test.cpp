// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A camera whose pixels have constant errors of 2 cm, in front of a wall and in a room.
class PatternedCamera : public testing::Test {
 protected:
  static constexpr double pattern_m = 0.02;

  PatternedCamera() {
    std::ofstream(folder_.path() / "wall.ply")
        << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "-20 -20 0\n20 -20 0\n20 20 0\n-20 20 0\n4 0 3 2 1\n";
  }

  /// Simulates SCENE with the errors of this camera.
  void simulate(const std::string& scene, const fs::path& out,
                const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"simulate", scene,
                                       "--out",    out.string(),
                                       "--set",    "simulator.width_px=44",
                                       "--set",    "simulator.height_px=36",
                                       "--set",    "simulator.range_noise_m=0.003",
                                       "--set",    "simulator.errors_seed=7",
                                       "--set",    "simulator.fixed_pattern_m=0.02"};
    for (const std::string& option : more) {
      arguments.insert(arguments.end(), {"--set", option});
    }
    const Finished finished = run_program(arguments);
    ASSERT_EQ(finished.status, 0) << finished.err;
  }

  /// Records a wall from these distances; the camera stands still in each frame, and has another
  /// tilt of up to `tilt_rad` in the next one. Writes the distances into wall.txt.
  void record_wall(const std::vector<double>& distances_m,
                   const std::vector<std::string>& more = {}, double tilt_rad = 0.06) const {
    std::ofstream poses(folder_.path() / "poses.txt");
    std::ofstream wall(folder_.path() / "wall.txt");
    for (std::size_t i = 0; i < distances_m.size(); ++i) {
      const double half_angle_rad = tilt_rad / 2 * std::sin(static_cast<double>(i));
      poses << i << " 0 0 " << -distances_m[i] << " " << std::sin(half_angle_rad) << " 0 0 "
            << std::cos(half_angle_rad) << '\n';
      wall << i << ' ' << distances_m[i] << '\n';
    }
    poses.close();
    std::vector<std::string> options{
        "simulator.trajectory_file=" + (folder_.path() / "poses.txt").string(),
        "simulator.b_delay_share=0"};
    options.insert(options.end(), more.begin(), more.end());
    simulate((folder_.path() / "wall.ply").string(), wall_, options);
  }

  /// Distances over more than a wavelength.
  static std::vector<double> many_distances(int count) {
    std::vector<double> distances_m;
    for (int i = 0; i < count; ++i) distances_m.push_back(0.8 + 3.2 * i / count);
    return distances_m;
  }

  Finished calibrate(const std::vector<std::string>& more = {},
                     const RunLimits& limits = {}) const {
    std::vector<std::string> arguments{
        "calibrate", wall_.string(),
        "--out",     calibration_.string(),
        "--set",     "calibration.wall_file=" + (folder_.path() / "wall.txt").string()};
    for (const std::string& option : more) {
      arguments.insert(arguments.end(), {"--set", option});
    }
    return run_program(arguments, limits);
  }

  /// Root mean square of the errors of unwrapped ranges of a recording, of pixels whose error is
  /// below three standard deviations of the pattern: most others have a wrong wrap count or lie on
  /// an edge.
  double range_rms_m(const fs::path& sequence, const std::vector<std::string>& more) const {
    const fs::path out = folder_.path() / "ranges";
    fs::remove_all(out);
    std::vector<std::string> arguments{"unwrap",     sequence.string(), "--out",
                                       out.string(), "--set",           "pictures.frames=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished finished = run_program(arguments);
    EXPECT_EQ(finished.status, 0) << finished.err;
    double squares_m2 = 0;
    int pixels = 0;
    for (const std::string& name : names_in(out / "range")) {
      const ImageF range_m = read_png_16(out / "range" / name).cast<float>() / 1000;
      const ImageF truth_m = read_png_16(sequence / "range_truth" / name).cast<float>() / 1000;
      for (Eigen::Index i = 0; i < range_m.size(); ++i) {
        const double error_m = range_m.data()[i] - truth_m.data()[i];
        if (range_m.data()[i] == 0 || truth_m.data()[i] == 0 || std::abs(error_m) > 3 * pattern_m) {
          continue;
        }
        squares_m2 += error_m * error_m;
        ++pixels;
      }
    }
    EXPECT_GT(pixels, 0);
    return std::sqrt(squares_m2 / pixels);
  }

  TemporaryFolder folder_;
  fs::path wall_ = folder_.path() / "wall";
  fs::path calibration_ = folder_.path() / "found" / "camera.yaml";
  fs::path pattern_ = folder_.path() / "found" / "camera.fixed_pattern.npy";
};

TEST_F(PatternedCamera, HasBetterRangesElsewhereAfterCalibrationOnAWall) {
  record_wall(many_distances(24));
  const Finished finished = calibrate();
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("fixed pattern at A: standard deviation"),
                                  HasSubstr("fixed pattern at B: standard deviation")));
  const CameraCalibration found = read_calibration(calibration_);
  ASSERT_EQ(found.fixed_pattern.size(), 2U);
  for (const ImageF& error_m : found.fixed_pattern) {
    EXPECT_NEAR(std::sqrt(error_m.square().mean()), pattern_m, 0.15 * pattern_m);
  }
  const fs::path room = folder_.path() / "room";
  simulate("wall", room, {"simulator.seed=2", "simulator.frames=4"});  // few edges
  const double before_m = range_rms_m(room, {});
  const double after_m = range_rms_m(room, {"--calibration", calibration_.string()});
  // What is left is noise, and what large pixels average over edges and oblique surfaces.
  EXPECT_GT(before_m, 0.6 * pattern_m);
  EXPECT_LT(after_m, 0.7 * before_m);

  const auto evaluated_m = [&](const std::vector<std::string>& more) {
    const fs::path out = folder_.path() / "evaluation";
    fs::remove_all(out);
    std::vector<std::string> arguments{"evaluate",   room.string(), "--out",
                                       out.string(), "--set",       "evaluation.methods=joint"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(arguments).status, 0);
    return read_json(out / "report.json")["unwrapping"]["joint"]["range_rmse_m"].get<double>();
  };
  EXPECT_LT(evaluated_m({"--calibration", calibration_.string()}), evaluated_m({}));
}

TEST_F(PatternedCamera, MayHaveThreeFrequenciesAndTrueRanges) {
  const fs::path room = folder_.path() / "room";
  const std::vector<std::string> three{"simulator.frequencies_hz=[80e6, 16e6, 120e6]"};
  simulate("room", room,
           {three[0], "simulator.frames=30", "simulator.max_translation_m=0.3",
            "simulator.max_rotation_deg=20"});
  const Finished finished =
      run_program({"calibrate", room.string(), "--out", calibration_.string()});
  ASSERT_EQ(finished.status, 0) << finished.err;
  const CameraCalibration found = read_calibration(calibration_);
  ASSERT_EQ(found.fixed_pattern.size(), 3U) << finished.out;
  const fs::path other = folder_.path() / "other";
  simulate("hall", other, {three[0], "simulator.seed=2", "simulator.frames=4"});
  EXPECT_LT(range_rms_m(other, {"--calibration", calibration_.string()}),
            0.8 * range_rms_m(other, {}));
}

TEST_F(PatternedCamera, HasNoPatternInTheCalibrationIfItIsOff) {
  record_wall(many_distances(12));
  const Finished finished = calibrate({"calibration.fixed_pattern=off"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, Not(HasSubstr("fixed pattern")));
  EXPECT_THAT(names_in(calibration_.parent_path()), testing::ElementsAre("camera.yaml"));
}

TEST_F(PatternedCamera, NeedsFiveFramesUnlessItIsToldOtherwise) {
  record_wall({0.8, 1.6, 2.4, 3.2});
  const Finished few = calibrate();
  ASSERT_EQ(few.status, 0) << few.err;
  EXPECT_THAT(few.out, HasSubstr("fixed pattern: not found from fewer than 5 frames"));
  EXPECT_FALSE(fs::exists(pattern_));
  ASSERT_EQ(calibrate({"calibration.fixed_pattern=on"}).status, 0);
  EXPECT_TRUE(fs::exists(pattern_));
}

TEST_F(PatternedCamera, NeedsDifferentRangesUnlessItIsToldOtherwise) {
  // Oblique enough for all phases: a wall at one distance whose ranges are 2 to 5 m.
  record_wall(std::vector<double>(8, 2), {"simulator.horizontal_fov_deg=125"}, 0);
  const Finished still = calibrate();
  ASSERT_EQ(still.status, 0) << still.err;
  EXPECT_THAT(still.out, HasSubstr("fixed pattern at A: left out, since the ranges of pixels"));
  EXPECT_FALSE(fs::exists(pattern_));
  const Finished asked = calibrate({"calibration.fixed_pattern=on"});
  ASSERT_EQ(asked.status, 0) << asked.err;
  EXPECT_THAT(asked.out, HasSubstr("warning: the ranges of pixels hardly change"));
  EXPECT_TRUE(fs::exists(pattern_));
}

TEST_F(PatternedCamera, CannotBeCalibratedByTheResidual) {
  record_wall(many_distances(12));
  const Finished finished =
      calibrate({"calibration.reference=residual", "calibration.fixed_pattern=on"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("calibration.fixed_pattern=on needs known ranges"),
                                  HasSubstr("calibration.wall_file")));
}

TEST_F(PatternedCamera, IsCalibratedAgainInPlaceOfTheEarlierCalibration) {
  record_wall(many_distances(12));
  ASSERT_EQ(calibrate().status, 0);
  const std::string before = read_text(pattern_);
  ASSERT_EQ(calibrate({"calibration.every_frame=2"}).status, 0);
  EXPECT_NE(read_text(pattern_), before);
  ASSERT_EQ(calibrate({"calibration.fixed_pattern=off"}).status, 0);
  EXPECT_THAT(names_in(calibration_.parent_path()), testing::ElementsAre("camera.yaml"))
      << "no calibration names the earlier pattern any more";
}

TEST_F(PatternedCamera, LeavesFilesAloneThatCalibrateDidNotWrite) {
  record_wall(many_distances(6));
  fs::create_directories(calibration_.parent_path());
  std::ofstream(pattern_) << "mine";
  const Finished refused = calibrate();
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("camera.fixed_pattern.npy"), HasSubstr("exists already")));
  EXPECT_EQ(read_text(pattern_), "mine");
  EXPECT_FALSE(fs::exists(calibration_));
  EXPECT_EQ(calibrate({"calibration.fixed_pattern=off"}).status, 0) << "then it is not in the way";
  EXPECT_EQ(read_text(pattern_), "mine");

  fs::remove(calibration_);
  std::ofstream(calibration_) << "format: tofmap-camera\nversion: 1\nfixed_pattern: my.npy\n";
  EXPECT_EQ(calibrate().status, 3) << "somebody wrote this pattern";
  EXPECT_THAT(read_text(calibration_), HasSubstr("my.npy"));
}

TEST_F(PatternedCamera, KeepsTheEarlierCalibrationIfTheDiskIsFull) {
  record_wall(many_distances(6));
  ASSERT_EQ(calibrate().status, 0);
  const std::string calibration = read_text(calibration_);
  const std::string pattern = read_text(pattern_);
  const Finished full = calibrate({"calibration.every_frame=2", "calibration.fixed_pattern=on"},
                                  {.max_file_bytes = 4096});
  EXPECT_EQ(full.status, 3) << full.out;
  EXPECT_THAT(full.err, HasSubstr("is the disk full?"));
  EXPECT_EQ(read_text(calibration_), calibration);
  EXPECT_EQ(read_text(pattern_), pattern);
  EXPECT_EQ(names_in(calibration_.parent_path()).size(), 2U) << "nothing else is left";
}

TEST_F(PatternedCamera, NeedsTheFileOfItsPattern) {
  record_wall(many_distances(6));
  ASSERT_EQ(calibrate().status, 0);
  fs::remove(pattern_);
  for (const std::string command : {"info", "unwrap", "map", "evaluate"}) {
    std::vector<std::string> arguments{command, wall_.string(), "--calibration",
                                       calibration_.string()};
    if (command != "info") {
      arguments.insert(arguments.end(), {"--out", (folder_.path() / "out").string()});
    }
    const Finished finished = run_program(arguments);
    EXPECT_EQ(finished.status, 3) << command;
    EXPECT_THAT(finished.err, AllOf(HasSubstr("camera.fixed_pattern.npy"),
                                    HasSubstr("keep both files in one folder")))
        << command;
  }
}

}  // namespace
}  // namespace tofmap::test
