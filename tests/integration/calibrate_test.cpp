// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;

/// A recording of a camera whose ranges swing by 2 cm four times a wavelength: that of a perfect
/// one, calibrated by the opposite error.
class Calibrate : public testing::Test {
 protected:
  static constexpr double swing_m = 0.02;

  Calibrate() {
    const fs::path perfect = folder_.path() / "perfect";
    EXPECT_EQ(run_program({"simulate", "room", "--frames", "12", "--out", perfect.string(), "--set",
                           "simulator.max_translation_m=0.3", "simulator.max_rotation_deg=20",
                           "simulator.range_noise_m=0.005"})
                  .status,
              0);
    CameraCalibration opposite;
    opposite.errors.resize(2);
    opposite.errors[0].harmonics = opposite.errors[1].harmonics = {{4, 0, -swing_m}};
    SequenceReader reader(perfect, opposite);
    SequenceWriter writer(sequence_, reader.sensor());
    while (const auto sourced = reader.next()) {
      writer.add(*sourced->frame, {}, reader.range_truth(sourced->index));
    }
  }

  CameraCalibration calibrate(const std::string& reference) const {
    const fs::path file = folder_.path() / (reference + ".yaml");
    const Finished finished = run_program({"calibrate", sequence_.string(), "--out", file.string(),
                                           "--set", "calibration.reference=" + reference});
    EXPECT_EQ(finished.status, 0) << finished.err;
    return read_calibration(file);
  }

  /// Of the ranges at A, the wraps of the truth given.
  double median_error_m(const CameraCalibration& calibration) const {
    SequenceReader reader(sequence_, calibration);
    const double wavelength_m = reader.sensor().modulation.wavelength_m(0);
    std::vector<double> errors_m;
    while (const auto sourced = reader.next()) {
      const ImageF truth_m = *reader.range_truth(sourced->index);
      for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
        const double off = sourced->frame->phases[0].data()[i] - truth_m.data()[i] / wavelength_m;
        if (!std::isnan(off)) errors_m.push_back(wavelength_m * std::abs(off - std::round(off)));
      }
    }
    return median(errors_m);
  }

  TemporaryFolder folder_;
  fs::path sequence_ = folder_.path() / "wiggling";
};

double amplitude_m(const PhaseError& error) {
  for (const WiggleHarmonic& harmonic : error.harmonics) {
    if (harmonic.order == 4) return std::hypot(harmonic.cosine_m, harmonic.sine_m);
  }
  return 0;
}

TEST_F(Calibrate, FindsThePeriodicErrorFromKnownRanges) {
  const CameraCalibration found = calibrate("truth");
  EXPECT_NEAR(amplitude_m(found.errors[0]), swing_m, 0.1 * swing_m);
  EXPECT_NEAR(amplitude_m(found.errors[1]), swing_m, 0.1 * swing_m);
  EXPECT_NEAR(found.errors[0].offset_m, 0, 0.003);
}

TEST_F(Calibrate, FindsThePeriodicErrorWithoutKnownRanges) {
  fs::remove_all(sequence_ / "range_truth");
  const CameraCalibration found = calibrate("auto");
  EXPECT_NEAR(amplitude_m(found.errors[0]), swing_m, 0.15 * swing_m);
  EXPECT_NEAR(amplitude_m(found.errors[1]), swing_m, 0.15 * swing_m);
}

TEST_F(Calibrate, MakesRangesBetter) {
  const double before_m = median_error_m({});
  EXPECT_GT(before_m, 0.5 * swing_m);
  EXPECT_LT(median_error_m(calibrate("residual")), 0.5 * before_m);
}

TEST_F(Calibrate, IsWrittenIntoTheOptionsOfWhatUsesIt) {
  calibrate("truth");
  const std::string file = (folder_.path() / "truth.yaml").string();
  const fs::path out = folder_.path() / "ranges";
  const Finished finished = run_program({"unwrap", sequence_.string(), "--out", out.string(),
                                         "--calibration", file, "--set", "pictures.frames=0"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(read_text(out / "options.yaml"), testing::HasSubstr(file));
}

TEST_F(Calibrate, LeavesOutFramesThatNoWallFills) {
  const fs::path wall = folder_.path() / "wall.txt";
  std::ofstream(wall) << "0 2.5\n";  // a corner of the furnished room
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.wall_file=" + wall.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("no flat wall fills the image"));
  EXPECT_THAT(finished.err, testing::HasSubstr(sequence_.string()));
  EXPECT_THAT(finished.err, testing::HasSubstr("too few pixels"));
}

TEST_F(Calibrate, DoesNotReplaceWhatIsNoCalibration) {
  const fs::path header = sequence_ / "sequence.yaml";
  const std::string before = read_text(header);
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", header.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("exists already"));
  EXPECT_EQ(read_text(header), before);
  calibrate("truth");
  calibrate("truth");  // but an earlier one is replaced
}

TEST_F(Calibrate, NamesFramesThatTheRecordingDoesNotHave) {
  const fs::path wall = folder_.path() / "wall.txt";
  std::ofstream(wall) << "0 2.5\n999 3\n";
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.wall_file=" + wall.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("frame 999"));
}

TEST_F(Calibrate, RefusesTrueRangesOfAnotherRecording) {
  const fs::path other = folder_.path() / "other";
  ASSERT_EQ(run_program({"simulate", "flat", "--frames", "12", "--out", other.string()}).status, 0);
  fs::remove_all(sequence_ / "range_truth");
  fs::copy(other / "range_truth", sequence_ / "range_truth");
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("does range_truth belong to this recording"));
  EXPECT_FALSE(fs::exists(folder_.path() / "c.yaml"));
}

TEST_F(Calibrate, AsksForTheUnitOfDistancesThatNoRangeReaches) {
  const fs::path wall = folder_.path() / "wall.txt";
  std::ofstream(wall) << "0 2500\n";
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.wall_file=" + wall.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("metres?"));
}

TEST_F(Calibrate, WarnsOfImagesThatAreMixedUp) {
  fs::rename(sequence_ / "phase_a", sequence_ / "phase");
  fs::rename(sequence_ / "phase_b", sequence_ / "phase_a");
  fs::rename(sequence_ / "phase", sequence_ / "phase_b");
  const Finished finished =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string()});
  EXPECT_THAT(finished.out, testing::HasSubstr("mixed up"));
}

TEST_F(Calibrate, RefusesRecordingsThatAreMostlyDamaged) {
  const auto run_after_damage_to = [&](std::size_t frames) {
    const std::vector<std::string> names = names_in(sequence_ / "phase_a");
    for (std::size_t i = 0; i < std::min(frames, names.size()); ++i) {
      std::ofstream(sequence_ / "phase_a" / names[i]) << "no image";
    }
    return run_program(
        {"calibrate", sequence_.string(), "--out", (folder_.path() / "camera.yaml").string()});
  };
  EXPECT_THAT(run_after_damage_to(1).out, testing::HasSubstr("warning: 1 of"));
  const Finished finished = run_after_damage_to(1000);
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, testing::HasSubstr("damaged"));
}

TEST_F(Calibrate, SaysWhatIsMissing) {
  fs::remove_all(sequence_ / "range_truth");
  const Finished none =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.reference=truth"});
  EXPECT_EQ(none.status, 3);
  EXPECT_THAT(none.err, testing::HasSubstr("range_truth"));
  const Finished wrong = run_program(
      {"info", sequence_.string(), "--calibration", (sequence_ / "sequence.yaml").string()});
  EXPECT_EQ(wrong.status, 3);
  EXPECT_THAT(wrong.err, testing::HasSubstr("tofmap-camera"));
  const Finished wall =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.reference=wall"});
  EXPECT_EQ(wall.status, 2);
  EXPECT_THAT(wall.err, testing::HasSubstr("calibration.wall_file"));
  const Finished order =
      run_program({"calibrate", sequence_.string(), "--out", (folder_.path() / "c.yaml").string(),
                   "--set", "calibration.harmonics=0"});
  EXPECT_EQ(order.status, 2);
  EXPECT_THAT(order.err, testing::HasSubstr("calibration.harmonics"));
}

}  // namespace
}  // namespace tofmap::test
