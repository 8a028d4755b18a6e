// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <support/waiting.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A recording that is played as a device, and what becomes of it.
class Device : public testing::Test {
 protected:
  static constexpr int frame_count = 12;

  explicit Device(const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments = {"simulate",
                                          "room",
                                          "--frames",
                                          std::to_string(frame_count),
                                          "--out",
                                          recording_.string(),
                                          "--set",
                                          "simulator.width_px=88",
                                          "simulator.height_px=72",
                                          "simulator.subpixels=2"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_program(arguments).status, 0);
  }

  /// Frames are made when they are asked for.
  std::string uri(const std::string& options = "") const {
    return "tofmap://" + recording_.string() + "?speed=-1" + (options.empty() ? "" : "&") + options;
  }

  Finished record(const std::string& from, std::vector<std::string> more = {}) {
    fs::remove_all(out_);
    std::vector<std::string> arguments = {"record", from, "--out", out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  nlohmann::json images() const { return read_json(out_ / "report.json")["acquisition"]["images"]; }

  /// Frames `first` … of what was recorded hold the ranges of the recording, to the step of the
  /// device's images.
  void expect_same_ranges(int count, int first = 0, double step_m = 1e-4) const {
    const SequenceReader original(recording_);
    const SequenceReader copy(out_);
    ASSERT_EQ(copy.frame_count(), count);
    const Modulation& modulation = original.sensor().modulation;
    ASSERT_EQ(copy.sensor().modulation.frequencies_hz, modulation.frequencies_hz);
    for (int i = 0; i < count; ++i) {
      const Frame wanted = *original.read(first + i).frame;
      const Frame found = *copy.read(i).frame;
      for (std::size_t f = 0; f < modulation.count(); ++f) {
        expect_same_phases(found.phases[f], wanted.phases[f], modulation.wavelength_m(f), step_m);
        EXPECT_TRUE((found.amplitudes[f] == wanted.amplitudes[f]).all());
      }
      EXPECT_NEAR(
          found.timestamp_s - copy.files()[0].timestamp_s,
          wanted.timestamp_s - original.files()[static_cast<std::size_t>(first)].timestamp_s, 2e-6)
          << "microseconds are OpenNI2's unit";
    }
  }

  static void expect_same_phases(const ImageF& found, const ImageF& wanted, double wavelength_m,
                                 double step_m) {
    ASSERT_TRUE((found.isNaN() == wanted.isNaN()).all());
    double worst_m = 0;
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      const double cycles = double{found.data()[i]} - double{wanted.data()[i]};
      if (std::isnan(cycles)) continue;
      worst_m = std::max(worst_m, wavelength_m * std::abs(cycles - std::round(cycles)));
    }
    // Half a step of the images, and half a step of a sequence's phase images. A range that rounds
    // to 0 is written as a whole wavelength, which is rounded to a step, too.
    const double whole_m = step_m * std::round(wavelength_m / step_m);
    EXPECT_LE(worst_m,
              0.5 * step_m + std::abs(wavelength_m - whole_m) + 0.5 * wavelength_m / 65535 + 1e-6);
  }

  TemporaryFolder folder_;
  fs::path recording_ = folder_.path() / "recording";
  fs::path out_ = folder_.path() / "out";
};

TEST_F(Device, IsRecordedToTheStepOfItsImages) {
  const Finished finished = record(uri());
  ASSERT_EQ(finished.status, 0) << finished.err;
  expect_same_ranges(frame_count);
  EXPECT_EQ(images()["paired"], 2 * frame_count);
  EXPECT_EQ(images()["lost"], 0);
}

TEST_F(Device, IsRecordedToAnOniFileThatPlaysTheSameRanges) {
  const fs::path oni = folder_.path() / "device.oni";
  ASSERT_EQ(record(uri(), {"--oni", oni.string()}).status, 0);
  const Finished again = record(oni.string());
  ASSERT_EQ(again.status, 0) << again.err;
  expect_same_ranges(frame_count);
  EXPECT_EQ(record(uri(), {"--oni", oni.string()}).status, 3) << "it is there already";
}

class DeviceAndFullDisk : public Device {
 protected:
  void SetUp() override {
    if (TOFMAP_COVERAGE) GTEST_SKIP() << "coverage is written to files, too";
  }
};

TEST_F(DeviceAndFullDisk, MakeASequenceWhereThereIsNoRoomForAnOniFile) {
  const fs::path oni = folder_.path() / "device.oni";
  const Finished finished =
      run_program({"record", uri(), "--out", out_.string(), "--oni", oni.string()},
                  {.max_file_bytes = 200'000});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("was the disk full?"));
  expect_same_ranges(frame_count);
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"out", "recording"}));
}

TEST_F(Device, DoesNotTakeThePlaceOfItsRecording) {
  const Finished finished = run_program({"record", uri(), "--out", recording_.string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("choose another output folder"));
  EXPECT_TRUE(fs::exists(recording_ / "groundtruth.txt"));
}

TEST_F(Device, IsNotRecordedToAnOniFileWhereItsRecordingGoes) {
  const Finished finished = record(uri(), {"--oni", (out_ / "device.oni").string()});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("--oni"));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Device, ThatDoesNotFitItsConfigurationGetsAWarning) {
  // 30 and 90 MHz: most ranges are longer than the wavelength that is claimed.
  const Finished finished = record(uri("layout=alternating"),
                                   {"--set", "device.layout=alternating",
                                    "device.frequency_a_hz=90e6", "device.frequency_b_hz=93e6"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("unpaired images"));
  EXPECT_THAT(finished.err, HasSubstr("device.first"));
}

TEST_F(DeviceAndFullDisk, MakeNothingWhereThereIsNoRoomForASequence) {
  const Finished finished =
      run_program({"record", uri(), "--out", out_.string()}, {.max_file_bytes = 1000});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("cannot be written"));
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"recording"});
}

/// A device that goes on until somebody ends it.
class EndlessDevice : public Device {
 protected:
  Finished interrupt(const std::string& command, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {command, uri("repeat=0"), "--out", out_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    RunningProgram program(arguments);
    EXPECT_TRUE(comes_true([&] { return !unfinished_result(folder_.path()).empty(); }));
    std::this_thread::sleep_for(std::chrono::seconds(3));  // some frames, even under sanitizers
    program.send(SIGINT);
    return program.wait();
  }
};

TEST_F(EndlessDevice, IsRecordedUntilInterrupted) {
  const fs::path oni = folder_.path() / "device.oni";
  const Finished finished = interrupt("record", {"--oni", oni.string()});
  EXPECT_EQ(finished.status, 130) << finished.err;
  const int recorded = *SequenceReader(out_).frame_count();
  EXPECT_GT(recorded, 0);
  EXPECT_EQ(read_json(out_ / "report.json")["interrupted"], true);
  EXPECT_EQ(record(oni.string()).status, 0);
  EXPECT_GE(SequenceReader(out_).frame_count(), recorded);
}

TEST_F(EndlessDevice, IsKeptWhereAnotherRecordingCameToItsFolder) {
  RunningProgram program({"record", uri("repeat=0"), "--out", out_.string()});
  ASSERT_TRUE(comes_true([&] { return !unfinished_result(folder_.path()).empty(); }));
  fs::copy(recording_, out_, fs::copy_options::recursive);
  std::this_thread::sleep_for(std::chrono::seconds(3));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_THAT(finished.err, HasSubstr("out-2"));
  EXPECT_EQ(SequenceReader(out_).frame_count(), frame_count);
  EXPECT_GT(SequenceReader(folder_.path() / "out-2").frame_count(), 0);
}

TEST_F(EndlessDevice, IsMappedUntilInterrupted) {
  const Finished finished = interrupt("map");
  EXPECT_EQ(finished.status, 130) << finished.err;
  const auto report = read_json(out_ / "report.json");
  EXPECT_EQ(report["acquisition"]["end"], "as asked");
  EXPECT_FALSE(read_trajectory(out_ / "trajectory.txt").empty());
  EXPECT_TRUE(fs::exists(out_ / "map.ply"));
}

TEST_F(Device, EndsAfterAsManyFramesAsAreWanted) {
  const fs::path oni = folder_.path() / "device.oni";
  ASSERT_EQ(record(uri(), {"--frames", "5", "--oni", oni.string()}).status, 0);
  expect_same_ranges(5);
  // OpenNI2 records what the device delivers, which may be more than was read.
  ASSERT_EQ(record(oni.string(), {"--frames", "5"}).status, 0);
  expect_same_ranges(5);
}

TEST_F(Device, MayDeliverDepthAlongItsAxis) {
  const Finished finished = record(uri("depth=z"), {"--frames", "2"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  const SequenceReader original(recording_);
  const SequenceReader copy(out_);
  const double wavelength_m = original.sensor().modulation.wavelength_m(0);
  const ImageF wanted = original.read(1).frame->phases[0];
  const ImageF found = copy.read(1).frame->phases[0];
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const double cycles = double{found.data()[i]} - double{wanted.data()[i]};
    if (std::isnan(cycles)) continue;
    // A step along the axis is up to 1.3 along a ray of this view.
    EXPECT_LE(wavelength_m * std::abs(cycles - std::round(cycles)), 1.5e-4);
  }
}

TEST_F(Device, EndsCleanlyWhenItIsUnplugged) {
  const Finished finished = record(uri("unplug_at=7"));
  ASSERT_EQ(finished.status, 0) << finished.err;
  expect_same_ranges(7);
  EXPECT_THAT(read_text(out_ / "report.json"), HasSubstr("unplugged"));
}

TEST_F(Device, ThatTakesBothFrequenciesInTurnIsPaired) {
  const std::vector<std::string> configured = {"--set", "device.layout=alternating",
                                               "device.depth=radial"};
  ASSERT_EQ(record(uri("layout=alternating"), configured).status, 0);
  expect_same_ranges(frame_count);

  // Every fifth image is lost: the fifth is A of the third frame, the tenth B of the fifth.
  ASSERT_EQ(record(uri("layout=alternating&lose_every=5"), configured).status, 0);
  const SequenceReader copy(out_);
  EXPECT_EQ(copy.frame_count(), frame_count - 4);
  EXPECT_EQ(images()["lost"], 4);
  EXPECT_EQ(images()["half_missing"], 2 * 4);
  EXPECT_EQ(images()["paired"], 4 * (frame_count - 4));
}

/// A device with one frequency, or with three as a Kinect v2.
class DeviceOfFrequencies : public Device, public testing::WithParamInterface<std::string> {
 protected:
  DeviceOfFrequencies() : Device({"simulator.frequencies_hz=" + GetParam()}) {}

  int frequencies() const { return 1 + static_cast<int>(std::ranges::count(GetParam(), ',')); }

  /// Depth in steps of 0.1 mm does not reach as far as a wavelength of 16 MHz.
  double step_m() const { return frequencies() == 1 ? 1e-4 : 1e-3; }
};

TEST_P(DeviceOfFrequencies, InTurnGivesWholeFrames) {
  const std::vector<std::string> configured = {"--set", "device.layout=alternating",
                                               "device.depth=radial", "device.first=a"};
  const Finished finished = record(uri("layout=alternating"), configured);
  ASSERT_EQ(finished.status, 0) << finished.err;
  expect_same_ranges(frame_count, 0, step_m());
  EXPECT_EQ(images()["paired"], 2 * frequencies() * frame_count);

  ASSERT_EQ(record(uri("layout=alternating&lose_every=6"), configured).status, 0);
  const SequenceReader copy(out_);
  const int lost = frequencies() * frame_count / 6;
  EXPECT_EQ(copy.frame_count(), frame_count - lost);
  EXPECT_EQ(images()["half_missing"], 2 * (frequencies() - 1) * lost);
}

TEST_P(DeviceOfFrequencies, InOneImageWithATagNeedsNoConfiguration) {
  const Finished finished = record(uri());
  ASSERT_EQ(finished.status, 0) << finished.err;
  expect_same_ranges(frame_count, 0, step_m());
}

TEST_P(DeviceOfFrequencies, IsNotTakenForOneThatBeginsWithAFrequencyItHasNot) {
  const Finished finished =
      record(uri("layout=alternating"), {"--set", "device.layout=alternating", "device.first=d"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("device.first"));
}

INSTANTIATE_TEST_SUITE_P(Counts, DeviceOfFrequencies,
                         testing::Values("[30e6]", "[80e6,16e6,120e6]"));

TEST_F(Device, ThatDoesNotSayHowItTakesBothFrequenciesMustBeConfigured) {
  const Finished finished = record(uri("layout=alternating"));
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("device.layout"));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Device, WhoseLossesAreCounted) {
  ASSERT_EQ(record(uri("lose_every=4")).status, 0);
  EXPECT_EQ(images()["paired"], 2 * (frame_count - 3));
  EXPECT_EQ(images()["lost"], 2) << "the last one is followed by none that tells";
}

TEST_F(Device, WhoseImagesDoNotBelongTogetherGetsAWarning) {
  // Each image is of one frequency: its upper half is no A to the B of its lower half.
  const Finished finished = record(uri("layout=alternating"), {"--set", "device.layout=stacked"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("warning: "));
  EXPECT_THAT(finished.out, HasSubstr("device.layout"));
  EXPECT_THAT(read_text(out_ / "report.json"), HasSubstr("device.layout"));
}

TEST_F(Device, WhoseDepthIsNoRangeGetsAWarning) {
  const Finished finished = record(uri("layout=alternating&depth=z"),
                                   {"--set", "device.layout=alternating", "device.depth=radial"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("device.depth=z"));
}

TEST(SlowDevice, IsNotWaitedForWhenItIsClosed) {
  const TemporaryFolder folder;
  // Many thousand rays a pixel: an image takes hours.
  const Finished finished =
      run_program({"record", "tofmap://room?simulator.subpixels=16&simulator.multipath_rays=4096",
                   "--out", (folder.path() / "out").string(), "--set", "device.timeout_s=0.2"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("device.timeout_s"));
}

TEST_F(Device, ThatFallsSilentIsNotWaitedForForEver) {
  const Finished finished =
      record("tofmap://" + recording_.string() + "?speed=0.0001", {"--set", "device.timeout_s=1"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("no image for 1 s"));
  EXPECT_EQ(SequenceReader(out_).frame_count(), 1) << "what came before is kept";
}

TEST_F(Device, IsMappedAsItsRecordingIs) {
  const fs::path from_device = folder_.path() / "from_device";
  const Finished finished = run_program({"map", uri(), "--out", from_device.string()});
  ASSERT_EQ(finished.status, 0) << finished.err;
  ASSERT_EQ(record(uri()).status, 0);
  const fs::path from_recording = folder_.path() / "from_recording";
  ASSERT_EQ(run_program({"map", out_.string(), "--out", from_recording.string()}).status, 0);
  const Trajectory one = read_trajectory(from_device / "trajectory.txt");
  const Trajectory other = read_trajectory(from_recording / "trajectory.txt");
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Pose difference = one[i].world_from_camera.inverse() * other[i].world_from_camera;
    // Phase images of a sequence are rounded once more.
    EXPECT_LT(difference.translation().norm(), 1e-3);
  }
  const auto report = read_json(from_device / "report.json");
  EXPECT_EQ(report["acquisition"]["end"], "end of the recording");
}

TEST_F(Device, CannotBeResumed) {
  const Finished finished = run_program({"map", uri(), "--out", out_.string(), "--resume"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("tofmap record"));
}

struct BadUri {
  std::string name;
  std::string uri;
  std::string complaint;
  int status = 3;
};

class BadDevice : public testing::TestWithParam<BadUri> {};

TEST_P(BadDevice, IsNamedAndLeavesNothing) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const Finished finished = run_program({"record", GetParam().uri, "--out", out.string()});
  EXPECT_EQ(finished.status, GetParam().status);
  EXPECT_THAT(finished.err, HasSubstr(GetParam().uri));
  EXPECT_THAT(finished.err, HasSubstr(GetParam().complaint));
  EXPECT_FALSE(fs::exists(out));
}

INSTANTIATE_TEST_SUITE_P(
    Uris, BadDevice,
    testing::Values(BadUri{"unknown_scene", "tofmap://nowhere", "allowed: ", 2},
                    BadUri{"unknown_option", "tofmap://room?spee=1", "unknown option spee", 2},
                    BadUri{"doubled_option", "tofmap://room?speed=1&speed=2", "twice", 2},
                    BadUri{"no_option", "tofmap://room?speed", "expected option=value", 2},
                    BadUri{"wrong_distortion", "tofmap://room?simulator.distortion_k1=-0.9",
                           "distortion", 2},
                    BadUri{"no_recording", "tofmap:///nowhere/at/all", "/nowhere/at/all"},
                    BadUri{"no_driver", "freenect://1", "cannot be opened"},
                    BadUri{"no_file", "nowhere.oni", "no such file"}),
    [](const auto& test) { return test.param.name; });

TEST(TumRecording, IsWrappedAndRead) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "depth");
  write_png(folder.path() / "depth" / "1.png", ImageU16(ImageU16::Constant(48, 64, 20000)));
  std::ofstream(folder.path() / "depth.txt") << "1.5 depth/1.png\n";
  const fs::path out = folder.path() / "out";
  const Finished finished = run_program({"simulate", "--from-tum", folder.path().string(), "--out",
                                         out.string(), "--set", "tum.cx_px=31.5", "tum.cy_px=23.5",
                                         "tum.fx_px=60", "tum.fy_px=60", "tum.every_pixel=1"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  const SequenceReader reader(out);
  EXPECT_EQ(reader.frame_count(), 1);
  EXPECT_NEAR((*reader.range_truth(0))(23, 31), 4, 0.002);
  EXPECT_EQ(run_program({"simulate", "room", "--from-tum", "x", "--out", out.string()}).status, 2);
  EXPECT_EQ(run_program({"simulate", "--out", out.string()}).status, 2);
}

TEST(TumRecording, LeavesOutImagesThatCannotBeRead) {
  const TemporaryFolder folder;
  write_png(folder.path() / "2.png", ImageU16(ImageU16::Constant(48, 64, 20000)));
  std::ofstream(folder.path() / "depth.txt") << "1 1.png\n2 2.png\n3 3.png\n";
  const fs::path out = folder.path() / "out";
  const std::vector<std::string> arguments = {"simulate", "--from-tum", folder.path().string(),
                                              "--out", out.string()};
  const Finished finished = run_program(arguments);
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("2 frames left out"));
  EXPECT_THAT(finished.err, HasSubstr("1.png"));
  EXPECT_EQ(SequenceReader(out).frame_count(), 1);
  fs::remove(folder.path() / "2.png");
  EXPECT_EQ(run_program(arguments).status, 3);
}

TEST(OniFile, ThatIsNoneOrTruncatedIsNamed) {
  const TemporaryFolder folder;
  const fs::path oni = folder.path() / "bad.oni";
  std::ofstream(oni) << "no recording";
  const Finished finished =
      run_program({"record", oni.string(), "--out", (folder.path() / "out").string()});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("bad.oni"));
}

}  // namespace
}  // namespace tofmap::test
