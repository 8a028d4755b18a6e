// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/kinect2_samples.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/acquisition/kinect2/recording.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr const char* manifest = R"({
  "version": 1,
  "device": {"serial": "42", "firmware": "4.0"},
  "streams": {"color": {"encoding": "jpeg"}, "depth": {"encoding": "kinect-v2-raw"}},
  "calibration": {
    "ir": {"fx": 365, "fy": 366, "cx": 256, "cy": 208, "k1": 0.09, "k2": -0.27, "k3": 0.1,
           "p1": 0, "p2": 0},
    "p0": "calibration/p0.bin"
  },
  "clocks": {"device": "kinect-v2-0.125ms-wrap32"}
})";

/// A line of frames.ndjson for the packet with this number, 30 frames a second.
std::string line(int number, std::uint64_t ticks, std::uint64_t sequence) {
  return R"({"index": 0, "stream": "depth", "path": "frames/depth/)" + std::to_string(number) +
         R"(.depth", "byte_count": 2984960, "device_timestamp": )" + std::to_string(ticks) +
         R"(, "sequence": )" + std::to_string(sequence) + R"(, "arrival_offset_us": 5})";
}

std::string line(int number) { return line(number, 1000 + 267 * number, 50 + number); }

/// A whole recording of five packets, for one thing at a time to go wrong in. The packets are empty
/// files of the right size.
class BadKinect2Recording : public testing::Test {
 protected:
  BadKinect2Recording() : folder_(parent_.path() / "recording") {
    std::filesystem::create_directories(folder_ / "frames/depth");
    std::filesystem::create_directories(folder_ / "calibration");
    write_p0_tables(folder_ / "calibration/p0.bin", test::sample_p0_tables());
    write("manifest.json", manifest);
    std::string lines;
    for (int i = 0; i < 5; ++i) {
      write_packet("frames/depth/" + std::to_string(i) + ".depth", packet_bytes);
      lines += line(i) + "\n";
    }
    write("frames.ndjson", lines);
    write("recording.complete", "complete\n");
  }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }

  void write_packet(const std::string& file, std::uintmax_t size) const {
    write(file, "");
    std::filesystem::resize_file(folder_ / file, size);
  }

  std::string text_of(const std::string& file) const {
    std::stringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }

  void replace(const std::string& file, const std::string& old_text,
               const std::string& new_text) const {
    std::string text = text_of(file);
    const std::size_t at = text.find(old_text);
    ASSERT_NE(at, std::string::npos) << old_text << " is not in " << text;
    write(file, text.replace(at, old_text.size(), new_text));
  }

  /// Writes the lines into frames.ndjson.
  void list(const std::vector<std::string>& lines) const {
    std::string text;
    for (const std::string& one : lines) text += one + "\n";
    write("frames.ndjson", text);
  }

  void expect_refusal(const std::vector<std::string>& parts) const {
    const std::string message = test::input_error([&] { open_recording(folder_); });
    for (const std::string& part : parts) test::expect_part(message, part);
  }

  /// Expects that the packets at these positions are damaged with messages that hold `part`, and no
  /// others.
  void expect_damage(const std::vector<int>& positions, const std::string& part) const {
    const Recording recording = open_recording(folder_);
    std::vector<int> damaged;
    double last_s = -1;
    for (const RecordedPacket& packet : recording.packets) {
      EXPECT_GE(packet.timestamp_s, last_s) << packet.index;
      last_s = packet.timestamp_s;
      if (packet.damage.empty()) continue;
      damaged.push_back(packet.index);
      test::expect_part(packet.damage, part);
    }
    EXPECT_EQ(damaged, positions) << part;
  }

  test::TemporaryFolder parent_;
  std::filesystem::path folder_;
};

TEST_F(BadKinect2Recording, IsWholeAtFirst) {
  expect_damage({}, "");
  const Recording recording = open_recording(folder_);
  EXPECT_EQ(recording.packets.size(), 5U);
  EXPECT_DOUBLE_EQ(recording.packets[1].timestamp_s, 1267 / 8000.0);
  EXPECT_EQ(recording.packets[1].sequence, 51U);
  EXPECT_EQ(recording.camera.cx_px, 255.5);
  EXPECT_EQ(recording.serial, "42");
}

TEST_F(BadKinect2Recording, IsMissingOrAFile) {
  std::filesystem::remove_all(folder_);
  expect_refusal({"recording: no such folder", "manifest.json"});
  std::ofstream(folder_) << "x";
  expect_refusal({"recording: is a file; give its folder"});
}

TEST_F(BadKinect2Recording, IsAnotherFolder) {
  std::filesystem::remove(folder_ / "manifest.json");
  std::filesystem::remove(folder_ / "frames.ndjson");
  expect_refusal({"recording: is no recording of a Kinect v2", ".depth"});
}

TEST_F(BadKinect2Recording, HasNoFrameList) {
  std::filesystem::remove(folder_ / "frames.ndjson");
  expect_refusal({"frames.ndjson: cannot be read"});
}

TEST_F(BadKinect2Recording, HasAnEmptyFrameListOrOneOfColorAlone) {
  list({});
  expect_refusal({"frames.ndjson: lists no depth packets"});
  list({R"({"index": 0, "stream": "color", "path": "frames/color/0.jpg"})", ""});
  expect_refusal({"frames.ndjson: lists no depth packets"});
}

TEST_F(BadKinect2Recording, HasNoPhaseOffsets) {
  std::filesystem::remove(folder_ / "calibration/p0.bin");
  expect_refusal({"calibration/p0.bin: no such file", "the camera's answer", "each camera"});
  const auto elsewhere = parent_.path() / "p0.bin";
  write_p0_tables(elsewhere, test::sample_p0_tables());
  EXPECT_EQ(open_recording(folder_, elsewhere).p0_file, elsewhere);
  EXPECT_THROW(open_recording(folder_, parent_.path() / "none.bin"), InputError);
}

TEST_F(BadKinect2Recording, HasPhaseOffsetsThatAreTruncated) {
  std::filesystem::resize_file(folder_ / "calibration/p0.bin", 1000);
  expect_refusal({"calibration/p0.bin: has 1000 bytes"});
}

TEST_F(BadKinect2Recording, HasAManifestThatIsNotJson) {
  replace("manifest.json", "\"device\": {", "\"device\" {");
  expect_refusal({"manifest.json: line 3 is not valid JSON"});
  write("manifest.json", "");
  expect_refusal({"manifest.json: line 1 is not valid JSON"});
  write("manifest.json", std::string(100'000, '['));
  expect_refusal({"manifest.json: line 1 is not valid JSON"});
  write("manifest.json", "{\"version\": 1e999}");
  expect_refusal({"manifest.json: holds a number that is too large"});
  write("manifest.json", std::string(2'000'000, ' '));
  expect_refusal({"manifest.json: is too large"});
  write("manifest.json", "[1, 2]");
  expect_refusal({"manifest.json: version is missing"});
}

TEST_F(BadKinect2Recording, HasAManifestThatIsCutOffAnywhere) {
  const std::string whole = manifest;
  for (std::size_t kept = 0; kept < whole.size(); kept += 7) {
    write("manifest.json", whole.substr(0, kept));
    expect_refusal({"manifest.json: line ", " is not valid JSON; is the file damaged?"});
  }
}

TEST_F(BadKinect2Recording, WithRandomBytesInItsTextsIsReadOrRefusedByName) {
  std::mt19937 random(8);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string file = i % 2 == 0 ? "manifest.json" : "frames.ndjson";
    const std::string whole = text_of(file);
    std::string text = whole;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random());
    write(file, text);
    try {
      EXPECT_FALSE(open_recording(folder_).packets.empty());
    } catch (const InputError& error) {
      ++refused;
      test::expect_part(error.what(), folder_.string());
    }
    write(file, whole);
  }
  EXPECT_GT(refused, 30);
}

TEST_F(BadKinect2Recording, HasAManifestThatNestsWithoutEnd) {
  const std::string nested = std::string(200'000, '[') + std::string(200'000, ']');
  replace("manifest.json", "\"version\": 1", "\"version\": " + nested);
  expect_refusal({"manifest.json: version must be 1 or 2, got an array"});
}

TEST_F(BadKinect2Recording, HasAnotherVersion) {
  replace("manifest.json", "\"version\": 1", "\"version\": 2");
  expect_damage({}, "");
  for (const char* version : {"3", "0", "-1", "1.5", "\"1\"", "null", "18446744073709551615"}) {
    write("manifest.json", manifest);
    replace("manifest.json", "\"version\": 1", std::string("\"version\": ") + version);
    expect_refusal({"manifest.json: version must be 1 or 2, got", version});
  }
}

TEST_F(BadKinect2Recording, HasAnotherEncodingOrClock) {
  replace("manifest.json", "kinect-v2-raw", "kinect-v3-raw");
  expect_refusal({"streams.depth.encoding must be 'kinect-v2-raw'", "kinect-v3-raw"});
  write("manifest.json", manifest);
  replace("manifest.json", "kinect-v2-0.125ms-wrap32", "seconds");
  expect_refusal({"clocks.device must be", "seconds"});
}

TEST_F(BadKinect2Recording, HasIntrinsicsOfNoCamera) {
  const std::vector<std::vector<std::string>> cases{
      {"\"fx\": 365", "\"fx\": 0", "calibration.ir.fx must be from 200 to 600 pixels"},
      {"\"fx\": 365", "\"fx\": 900", "calibration.ir.fx must be from 200 to 600 pixels"},
      {"\"fy\": 366", "\"fy\": -366", "calibration.ir.fy must be from 200 to 600 pixels"},
      {"\"fx\": 365", "\"fx\": null", "calibration.ir.fx must be a number, got null"},
      {"\"fx\": 365", "\"fx\": \"365\"", "calibration.ir.fx must be a number"},
      {"\"fx\": 365, ", "", "calibration.ir.fx is missing"},
      {"\"fx\": 365", "\"fx\": 1e300", "calibration.ir.fx must be from 200 to 600 pixels"},
      {"\"cx\": 256", "\"cx\": 513", "calibration.ir.cx must be in the image, from 0 to 512"},
      {"\"cx\": 256", "\"cx\": -1", "calibration.ir.cx must be in the image"},
      {"\"cy\": 208", "\"cy\": 425", "calibration.ir.cy must be in the image, from 0 to 424"},
      {"\"k2\": -0.27", "\"k2\": -27", "calibration.ir: camera: the distortion"},
      {"\"k3\": 0.1", "\"k3\": {}", "calibration.ir.k3 must be a number, got an object"},
      {"\"ir\":", "\"infrared\":", "calibration.ir.fx is missing"}};
  for (const std::vector<std::string>& one : cases) {
    write("manifest.json", manifest);
    replace("manifest.json", one[0], one[1]);
    expect_refusal({"manifest.json: ", one[2]});
  }
}

TEST_F(BadKinect2Recording, HasAPathOfPhaseOffsetsThatLeadsOut) {
  for (const char* path : {"../p0.bin", "/etc/passwd", "", "a/../../b"}) {
    write("manifest.json", manifest);
    replace("manifest.json", "calibration/p0.bin", path);
    expect_refusal({"manifest.json: calibration.p0: the path"});
  }
}

TEST_F(BadKinect2Recording, HasNoManifestAlthoughItIsComplete) {
  std::filesystem::remove(folder_ / "manifest.json");
  expect_refusal({"manifest.json: no such file", "remove recording.complete"});
}

TEST_F(BadKinect2Recording, HasNoManifestBecauseItWasInterrupted) {
  std::filesystem::remove(folder_ / "manifest.json");
  std::filesystem::remove(folder_ / "recording.complete");
  const Recording recording = open_recording(folder_);
  EXPECT_FALSE(recording.is_complete);
  EXPECT_TRUE(recording.camera_is_assumed);
  EXPECT_EQ(recording.camera.fx_px, typical_intrinsics.fx);
  expect_damage({}, "");
}

TEST_F(BadKinect2Recording, HasAnEmptyMarkOfItsEnd) {
  write("recording.complete", "");
  EXPECT_FALSE(open_recording(folder_).is_complete);
}

TEST_F(BadKinect2Recording, WasInterruptedInItsLastLine) {
  std::filesystem::remove(folder_ / "recording.complete");
  const std::string cut = line(4).substr(0, 60);
  write("frames.ndjson", line(0) + "\n" + line(1) + "\n" + cut);
  expect_damage({}, "");
  const Recording recording = open_recording(folder_);
  EXPECT_EQ(recording.packets.size(), 2U);
  EXPECT_EQ(recording.unfinished_line, "frames.ndjson:3");
  // A line that lacks only its line feed is whole.
  write("frames.ndjson", line(0) + "\n" + line(1));
  EXPECT_EQ(open_recording(folder_).packets.size(), 2U);
  EXPECT_EQ(open_recording(folder_).unfinished_line, "");
  // What is cut off elsewhere, or in a complete recording, is damage.
  write("frames.ndjson", line(0) + "\n" + cut + "\n" + line(1) + "\n");
  expect_damage({1}, "frames.ndjson:2");
  write("recording.complete", "complete\n");
  write("frames.ndjson", line(0) + "\n" + line(1) + "\n" + cut);
  expect_damage({2}, "frames.ndjson:3");
  EXPECT_EQ(open_recording(folder_).unfinished_line, "");
}

TEST_F(BadKinect2Recording, HasALineThatIsNotUnderstood) {
  const std::string good = line(2);
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string text = good;
    return text.replace(text.find(old_text), old_text.size(), new_text);
  };
  const std::vector<std::vector<std::string>> cases{
      {"not json", "is not a JSON object"},
      {"\xff\xfe", "is not a JSON object"},
      {"[1]", "is not a JSON object"},
      {"{}", "stream must be a text"},
      {with("\"depth\"", "\"sound\""), "stream must be color or depth, got \"sound\""},
      {with("\"frames/depth/2.depth\"", "7"), "path must be a text"},
      {with("frames/depth/2.depth", ""), "the path is empty"},
      {with("frames/depth/2.depth", "../2.depth"),
       "the path '../2.depth' leads out of the recording"},
      {with("frames/depth/2.depth", "/etc/passwd"), "the path '/etc/passwd' leads out"},
      {with("frames/depth/2.depth", "a\\u0000b"), "the path is empty or not valid"},
      {with("1534", "-1534"), "device_timestamp must be a whole number from 0 to 4294967295"},
      {with("1534", "4294967296"), "device_timestamp must be a whole number"},
      {with("1534", "1e99"), "device_timestamp must be a whole number"},
      {with("1534", "1e999"), "is not a JSON object"},
      {with("1534", "\"noon\""), "device_timestamp must be a whole number"},
      {with("\"device_timestamp\"", "\"time\""), "device_timestamp is missing"},
      {with("52", "5.5"), "sequence must be a whole number"},
      {with("2984960", "-1"), "byte_count must be a whole number"},
      {with("2984960", "{}"), "byte_count must be a whole number from 0 to 4294967295, got an"}};
  for (const std::vector<std::string>& one : cases) {
    list({line(0), line(1), one[0], line(3)});
    expect_damage({2}, "frames.ndjson:3: " + one[1]);
    EXPECT_EQ(open_recording(folder_).packets[2].timestamp_s, 1267 / 8000.0);
    EXPECT_EQ(open_recording(folder_).never_recorded, 0U) << "the frame may be in that line";
  }
}

TEST_F(BadKinect2Recording, HasAPacketThatIsMissingOrOfAnotherSize) {
  const std::string file = "frames/depth/3.depth";
  std::filesystem::remove(folder_ / file);
  expect_damage({3}, "3.depth: no such file");
  std::filesystem::create_directory(folder_ / file);
  expect_damage({3}, "3.depth: is not a regular file");
  std::filesystem::remove(folder_ / file);
  write_packet(file, packet_bytes - 1);
  expect_damage({3}, "3.depth: has 2984959 bytes; a depth packet has 2984960, so it is truncated");
  write_packet(file, 0);
  expect_damage({3}, "3.depth: has 0 bytes");
  write_packet(file, std::uintmax_t{1} << 40U);
  expect_damage({3}, "3.depth: has 1099511627776 bytes");
}

TEST_F(BadKinect2Recording, SaysThatAPacketHasAnotherSizeThanPacketsHave) {
  replace("frames.ndjson", "2984960", "298496");
  expect_damage({0}, "frames.ndjson:1: byte_count is 298496; a depth packet has 2984960 bytes");
}

TEST_F(BadKinect2Recording, ListsAPacketTwice) {
  list({line(0), line(1), line(1, 5000, 60), line(2, 6000, 61)});
  expect_damage({2}, "1.depth is listed twice");
}

TEST_F(BadKinect2Recording, HasTimesOrNumbersThatStandStillOrGoBack) {
  list({line(0, 100, 1), line(1, 100, 2), line(2, 300, 3)});
  expect_damage({1}, "its sequence number 2 and timestamp 100 are not both later than 1 and 100");
  list({line(0, 100, 1), line(1, 200, 1), line(2, 300, 2)});
  expect_damage({1}, "not both later");
  list({line(0, 100, 5), line(1, 200, 6), line(2, 150, 7), line(3, 300, 4), line(4, 400, 8)});
  expect_damage({2, 3}, "not both later than 6 and 200");
  list({line(0, 100, 1), line(1, 100, 1), line(2, 300, 3)});
  expect_damage({1}, "the frame is listed twice");
}

TEST_F(BadKinect2Recording, HasOneTimeFarAhead) {
  list({line(0, 100, 1), line(1, 900000, 2), line(2, 300, 3), line(3, 400, 4)});
  expect_damage({1}, "not both earlier than the next ones, 3 and 300");
  list({line(0, 900000, 1), line(1, 200, 2), line(2, 300, 3), line(3, 400, 4)});
  expect_damage({0}, "not both earlier");
  EXPECT_EQ(open_recording(folder_).packets[0].timestamp_s, 200 / 8000.0);
}

TEST_F(BadKinect2Recording, CountsTimeAndFramesOnWhereTheyWrap) {
  const std::uint64_t end = std::uint64_t{1} << 32U;
  list({line(0, end - 100, end - 1), line(1, 100, 0), line(2, 300, 1)});
  expect_damage({}, "");
  const Recording recording = open_recording(folder_);
  EXPECT_DOUBLE_EQ(recording.packets[2].timestamp_s, (static_cast<double>(end) + 300) / 8000);
  EXPECT_EQ(recording.never_recorded, 0U);
}

TEST_F(BadKinect2Recording, LacksFramesThatTheCameraCounted) {
  list({line(0, 100, 10), line(1, 200, 11), line(2, 300, 15), line(3, 400, 17)});
  expect_damage({}, "");
  EXPECT_EQ(open_recording(folder_).never_recorded, 4U);
  // A packet that was recorded but is gone is damage, not a gap.
  std::filesystem::remove(folder_ / "frames/depth/1.depth");
  EXPECT_EQ(open_recording(folder_).never_recorded, 4U);
}

/// A folder of loose packets with their P0 tables.
class LooseKinect2Packets : public BadKinect2Recording {
 protected:
  LooseKinect2Packets() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
    write_p0_tables(folder_ / "p0.bin", test::sample_p0_tables());
  }

  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const RecordedPacket& packet : open_recording(folder_).packets) {
      found.push_back(packet.file.filename().string());
    }
    return found;
  }
};

TEST_F(LooseKinect2Packets, AreListedInTheOrderOfTheirTimes) {
  for (const char* name : {"a_1000_9.depth", "a_200_3.depth", "my_cam_400_5.depth"}) {
    write_packet(name, packet_bytes);
  }
  write_packet("a_300_4.jpg", 5);
  expect_damage({}, "");
  EXPECT_EQ(names(),
            (std::vector<std::string>{"a_200_3.depth", "my_cam_400_5.depth", "a_1000_9.depth"}));
  const Recording recording = open_recording(folder_);
  EXPECT_TRUE(recording.is_complete);
  EXPECT_TRUE(recording.camera_is_assumed);
  EXPECT_EQ(recording.camera.fx_px, 365.456);
  EXPECT_EQ(recording.camera.cx_px, 254.878 - 0.5);
  EXPECT_DOUBLE_EQ(recording.packets[1].timestamp_s, 0.05);
  EXPECT_EQ(recording.packets[1].sequence, 5U);
  EXPECT_EQ(recording.never_recorded, 4U);
}

TEST_F(LooseKinect2Packets, BeginBeforeTheClockWraps) {
  for (const char* name : {"a_100_8.depth", "a_4294967200_7.depth", "a_4294960000_6.depth"}) {
    write_packet(name, packet_bytes);
  }
  expect_damage({}, "");
  EXPECT_EQ(names(), (std::vector<std::string>{"a_4294960000_6.depth", "a_4294967200_7.depth",
                                               "a_100_8.depth"}));
}

TEST_F(LooseKinect2Packets, WithOtherNamesOrSizesAreDamaged) {
  write_packet("a_100_1.depth", packet_bytes);
  write_packet("a_200_2.depth", 100);
  for (const char* name : {"a.depth", "100_1.depth", "a_-5_3.depth", "a_5_x.depth",
                           "a_99999999999_3.depth", "a__.depth"}) {
    write_packet(name, packet_bytes);
    const Recording recording = open_recording(folder_);
    ASSERT_EQ(recording.packets.size(), 3U);
    EXPECT_EQ(recording.packets[0].damage, "");
    test::expect_part(recording.packets[1].damage, "a_200_2.depth: has 100 bytes");
    test::expect_part(recording.packets[2].damage, std::string(name) + ": its name must be");
    std::filesystem::remove(folder_ / name);
  }
}

TEST_F(LooseKinect2Packets, TakeTheirPhaseOffsetsFromSeveralPlaces) {
  write_packet("a_100_1.depth", packet_bytes);
  EXPECT_EQ(open_recording(folder_).p0_file, folder_ / "p0.bin");
  std::filesystem::rename(folder_ / "p0.bin", folder_ / "p0tables.dat");
  EXPECT_EQ(open_recording(folder_).p0_file, folder_ / "p0tables.dat");
  std::filesystem::create_directory(folder_ / "calibration");
  std::filesystem::rename(folder_ / "p0tables.dat", folder_ / "calibration/p0.bin");
  EXPECT_EQ(open_recording(folder_).p0_file, folder_ / "calibration/p0.bin");
  std::filesystem::rename(folder_ / "calibration/p0.bin", parent_.path() / "mine.bin");
  expect_refusal({"p0.bin: no such file", "the camera's answer", "each camera has its own"});
  EXPECT_NO_THROW(open_recording(folder_, parent_.path() / "mine.bin"));
}

}  // namespace
}  // namespace tofmap::kinect2
