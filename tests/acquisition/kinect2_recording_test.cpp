// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/kinect2_samples.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/acquisition/kinect2/recording.hpp>
#include <tofmap/acquisition/kinect2/recording_writer.hpp>

namespace tofmap::kinect2 {
namespace {

/// The camera of recordings that are written here.
CameraModel sample_camera() {
  return camera_of({366.5, 365.25, 257.125, 208.75, 0.09, -0.27, 0.1, 0.001, -0.002});
}

class Kinect2Recording : public testing::Test {
 protected:
  Kinect2Recording() : folder_(parent_.path() / "recording") {}

  RecordingWriter writer() const {
    return {folder_, sample_camera(), test::sample_p0_tables(), "012345"};
  }

  std::string text_of(const char* file) const {
    std::stringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }

  test::TemporaryFolder parent_;
  std::filesystem::path folder_;
};

TEST_F(Kinect2Recording, ReadsBackAsWritten) {
  const std::vector<double> times_s{3.5, 3.533375, 3.566625, 3.75};
  RecordingWriter out = writer();
  for (int i = 0; i < 4; ++i) out.add(test::sample_measurements(i), times_s[i]);
  EXPECT_EQ(out.count(), 4);
  out.finish();

  const Recording recording = open_recording(folder_);
  EXPECT_TRUE(recording.is_complete);
  EXPECT_EQ(recording.unfinished_line, "");
  EXPECT_EQ(recording.never_recorded, 0U);
  EXPECT_EQ(recording.serial, "012345");
  EXPECT_FALSE(recording.camera_is_assumed);
  const CameraModel camera = sample_camera();
  EXPECT_EQ(recording.camera.width_px, 512);
  EXPECT_EQ(recording.camera.height_px, 424);
  EXPECT_EQ(recording.camera.fx_px, camera.fx_px);
  EXPECT_EQ(recording.camera.fy_px, camera.fy_px);
  EXPECT_EQ(recording.camera.cx_px, camera.cx_px);
  EXPECT_EQ(recording.camera.cy_px, camera.cy_px);
  EXPECT_EQ(recording.camera.distortion, camera.distortion);
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_TRUE((recording.p0.tables[f] == test::sample_p0_tables().tables[f]).all());
  }
  ASSERT_EQ(recording.packets.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const RecordedPacket& packet = recording.packets[i];
    EXPECT_EQ(packet.damage, "");
    EXPECT_EQ(packet.index, i);
    EXPECT_EQ(packet.sequence, static_cast<unsigned>(i));
    EXPECT_DOUBLE_EQ(packet.timestamp_s, times_s[i]);
    EXPECT_TRUE(test::same_measurements(read_packet(packet.file), test::sample_measurements(i)));
  }
}

TEST_F(Kinect2Recording, IsReadableAfterEveryPacketBeforeItIsFinished) {
  RecordingWriter out = writer();
  test::expect_part(test::input_error([&] { open_recording(folder_); }), "lists no depth packets");
  for (int i = 0; i < 2; ++i) {
    out.add(test::sample_measurements(i), i);
    const Recording recording = open_recording(folder_);
    EXPECT_FALSE(recording.is_complete);
    EXPECT_FALSE(recording.camera_is_assumed);
    ASSERT_EQ(recording.packets.size(), static_cast<std::size_t>(i) + 1);
    EXPECT_EQ(recording.packets.back().damage, "");
  }
  out.finish();
  EXPECT_TRUE(open_recording(folder_).is_complete);
  EXPECT_NO_THROW(out.finish());
  EXPECT_THROW(out.add(test::sample_measurements(), 5), UsageError);
}

TEST_F(Kinect2Recording, HasTheKeysThatLibfreenect2Wants) {
  RecordingWriter out = writer();
  out.add(test::sample_measurements(), 1);
  out.finish();
  const std::string manifest = text_of("manifest.json");
  for (const char* part :
       {"\"version\": 2", "\"serial\": \"012345\"", "\"encoding\": \"jpeg\"",
        "\"encoding\": \"kinect-v2-raw\"", "\"fx\": 366.5", "\"cx\": 257.125", "\"k3\": 0.1",
        "\"p2\": -0.002", "\"my_x0y0\"", "\"p0\": \"calibration/p0.bin\"",
        "\"device\": \"kinect-v2-0.125ms-wrap32\""}) {
    test::expect_part(manifest, part);
  }
  EXPECT_EQ(text_of("frames.ndjson"),
            "{\"index\":0,\"stream\":\"depth\",\"path\":\"frames/depth/0000000000.depth\","
            "\"byte_count\":2984960,\"device_timestamp\":8000,\"sequence\":0,"
            "\"arrival_offset_us\":0}\n");
  EXPECT_NE(text_of("recording.complete"), "");
}

TEST_F(Kinect2Recording, CountsTimeOnWhereTheClockWraps) {
  const double period_s = std::ldexp(1, 32) / 8000;
  RecordingWriter out = writer();
  const std::vector<double> times_s{period_s - 0.5, period_s + 0.5, period_s + 2 * 86400};
  for (const double time_s : times_s) out.add(test::sample_measurements(), time_s);
  const Recording recording = open_recording(folder_);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    EXPECT_EQ(recording.packets[i].damage, "");
    EXPECT_DOUBLE_EQ(recording.packets[i].timestamp_s, times_s[i]);
  }
}

TEST_F(Kinect2Recording, WithTimesThatDoNotIncreaseIsWrongUse) {
  RecordingWriter out = writer();
  EXPECT_THROW(out.add(test::sample_measurements(), -0.1), UsageError);
  EXPECT_THROW(out.add(test::sample_measurements(), std::nan("")), UsageError);
  EXPECT_THROW(out.add(test::sample_measurements(), 1e300), UsageError);
  out.add(test::sample_measurements(), 0);
  EXPECT_THROW(out.add(test::sample_measurements(), 0), UsageError);
  EXPECT_THROW(out.add(test::sample_measurements(), 0.00005), UsageError) << "the same tick";
  EXPECT_THROW(out.add(test::sample_measurements(), 4 * 86400), UsageError);
  EXPECT_THROW(out.add(Measurements{}, 1), UsageError);
  out.add(test::sample_measurements(), 2);
  EXPECT_EQ(open_recording(folder_).packets.size(), 2U);
}

TEST_F(Kinect2Recording, OfAnotherCameraOrWithoutASerialIsWrongUse) {
  const P0Tables p0 = test::sample_p0_tables();
  EXPECT_THROW(RecordingWriter(folder_, pinhole_camera(1, 320, 240), p0, "1"), UsageError);
  EXPECT_THROW(RecordingWriter(folder_, sample_camera(), p0, ""), UsageError);
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(Kinect2Recording, IsNotWrittenIntoAFolderWithFilesInIt) {
  std::filesystem::create_directory(folder_);
  std::ofstream(folder_ / "note.txt") << "mine";
  test::expect_part(test::input_error([&] { writer(); }), "recording: is not empty");
  EXPECT_EQ(text_of("note.txt"), "mine");
}

TEST_F(Kinect2Recording, ThatCannotBeWrittenIsNamed) {
  std::ofstream(folder_) << "a file";
  test::expect_part(test::input_error([&] { writer(); }), folder_.string());
}

}  // namespace
}  // namespace tofmap::kinect2
