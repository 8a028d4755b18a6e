// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/kinect2_samples.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/companding.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>

namespace tofmap::kinect2 {
namespace {

/// The measurements of all codes as libfreenect2's table is built: by adding up step after step.
std::vector<int> summed_table() {
  std::vector<int> table(2048);
  int magnitude = 0;
  for (int code = 0; code < 1024; ++code) {
    table[code] = magnitude;
    table[1024 + code] = -magnitude;
    magnitude += code < 128 ? 1 : 1 << (code / 128 - 1);
  }
  table[1024] = 32767;
  return table;
}

TEST(Kinect2Companding, HasTheMeasurementsThatStepsAddUpTo) {
  const std::vector<int> table = summed_table();
  for (int code = 0; code < code_count; ++code) {
    EXPECT_EQ(measurement_of_code(code), table[code]) << code;
  }
}

TEST(Kinect2Companding, HasTheMeasurementsOfWorkedExamples) {
  EXPECT_EQ(measurement_of_code(0), 0);
  EXPECT_EQ(measurement_of_code(255), 255);
  EXPECT_EQ(measurement_of_code(257), 258);
  EXPECT_EQ(measurement_of_code(384), 512);
  EXPECT_EQ(measurement_of_code(1023), largest_magnitude);
  EXPECT_EQ(measurement_of_code(1024), saturated_measurement);
  EXPECT_EQ(measurement_of_code(1025), -1);
  EXPECT_EQ(measurement_of_code(2047), -largest_magnitude);
}

TEST(Kinect2Companding, TakesEveryCodeBack) {
  for (int code = 0; code < code_count; ++code) {
    EXPECT_EQ(nearest_code(measurement_of_code(code)), code);
  }
}

TEST(Kinect2Companding, PicksACodeThatNoOtherOneIsNearerThan) {
  const std::vector<int> table = summed_table();
  for (int measurement = -16351; measurement <= 16351; ++measurement) {
    int least = 1 << 20;
    for (int code = 0; code < code_count; ++code) {
      if (code != saturation_code) least = std::min(least, std::abs(table[code] - measurement));
    }
    const int code = nearest_code(measurement);
    ASSERT_NE(code, saturation_code) << measurement;
    ASSERT_EQ(std::abs(table[code] - measurement), least) << measurement;
  }
}

TEST(Kinect2Companding, SaturatesBeyondTheLargestMagnitude) {
  for (const int measurement : {16352, -16352, 20000, 32767, -32768, 1 << 30, -(1 << 30)}) {
    EXPECT_EQ(nearest_code(measurement), saturation_code) << measurement;
  }
}

TEST(Kinect2Companding, OfACodeThatDoesNotExistIsWrongUse) {
  EXPECT_THROW(measurement_of_code(-1), UsageError);
  EXPECT_THROW(measurement_of_code(2048), UsageError);
}

/// The code of a pixel, bit by bit, as the format is described for images that are upside down:
/// row y is stored as row y + 212 if y < 212, otherwise as row 423 - y.
int code_bit_by_bit(const std::vector<std::uint8_t>& packet, int sub_image, int v, int u) {
  const int y = 423 - v;
  const int stored_row = y < 212 ? y + 212 : 423 - y;
  const int position = u / 4 + 128 * (u % 4);
  int code = 0;
  for (int i = 0; i < 11; ++i) {
    const int bit = 11 * position + i;
    const int word_at = 298496 * sub_image + 704 * stored_row + 2 * (bit / 16);
    const int word = packet[word_at] + 256 * packet[word_at + 1];
    code += ((word >> (bit % 16)) & 1) << i;
  }
  return code;
}

TEST(Kinect2Packet, OfRandomBytesDecodesAsReadingItBitByBit) {
  std::vector<std::uint8_t> packet(packet_bytes);
  std::mt19937 random(5);
  for (std::uint8_t& byte : packet) byte = static_cast<std::uint8_t>(random());
  const std::vector<int> table = summed_table();
  const Measurements measurements = decode_packet(packet);
  int differing = 0;
  for (int sub_image = 0; sub_image < 9; ++sub_image) {
    const Image<std::int16_t>& image = measurements.steps[sub_image / 3][sub_image % 3];
    ASSERT_EQ(image.rows(), 424);
    ASSERT_EQ(image.cols(), 512);
    for (int v = 0; v < 424; ++v) {
      EXPECT_EQ(image(v, 0), 0);
      EXPECT_EQ(image(v, 511), 0);
      for (int u = 1; u < 511; ++u) {
        if (image(v, u) != table[code_bit_by_bit(packet, sub_image, v, u)]) ++differing;
      }
    }
  }
  EXPECT_EQ(differing, 0);
}

TEST(Kinect2Packet, ReturnsTheMeasurementsThatWereEncoded) {
  const Measurements measurements = test::sample_measurements();
  const std::vector<std::uint8_t> packet = encode_packet(measurements);
  ASSERT_EQ(packet.size(), packet_bytes);
  EXPECT_TRUE(test::same_measurements(decode_packet(packet), measurements));
}

TEST(Kinect2Packet, RoundsMeasurementsToThoseOfTheNearestCode) {
  Measurements measurements = test::sample_measurements();
  std::mt19937 random(6);
  Measurements rounded = measurements;
  for (std::size_t f = 0; f < 3; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (int v = 0; v < 424; ++v) {
        for (int u = 1; u < 511; ++u) {
          const auto value = static_cast<std::int16_t>(random());
          measurements.steps[f][k](v, u) = value;
          rounded.steps[f][k](v, u) = measurement_of_code(nearest_code(value));
        }
      }
    }
  }
  EXPECT_TRUE(test::same_measurements(decode_packet(encode_packet(measurements)), rounded));
}

TEST(Kinect2Packet, ThatTheEncoderWroteIsEncodedAgainToTheSameBytes) {
  Measurements measurements = test::sample_measurements();
  measurements.steps[1][2](7, 9) = saturated_measurement;
  const std::vector<std::uint8_t> packet = encode_packet(measurements);
  EXPECT_EQ(encode_packet(decode_packet(packet)), packet);
}

TEST(Kinect2Packet, KeepsSaturationOfSingleSteps) {
  Measurements measurements = test::sample_measurements();
  measurements.steps[0][1](0, 1) = saturated_measurement;
  measurements.steps[2][0](423, 510) = saturated_measurement;
  const Measurements decoded = decode_packet(encode_packet(measurements));
  EXPECT_TRUE(test::same_measurements(decoded, measurements));
}

TEST(Kinect2Packet, OfAnotherSizeIsAnInputErrorThatNamesBothSizes) {
  for (const std::size_t size : {std::size_t{0}, packet_bytes - 1, packet_bytes + 1}) {
    const std::vector<std::uint8_t> packet(size);
    const std::string message = test::input_error([&] { decode_packet(packet); });
    test::expect_part(message, "2984960");
    test::expect_part(message, std::to_string(size));
  }
}

TEST(Kinect2Packet, OfImagesOfAnotherSizeIsWrongUse) {
  Measurements measurements = test::sample_measurements();
  measurements.steps[2][2].setZero(512, 424);
  EXPECT_THROW(encode_packet(measurements), UsageError);
  EXPECT_THROW(encode_packet(Measurements{}), UsageError);
}

TEST(Kinect2Packet, IsReadFromAFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.depth";
  const std::vector<std::uint8_t> packet = encode_packet(test::sample_measurements());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(packet.data()),
             static_cast<std::streamsize>(packet.size()));
  EXPECT_TRUE(test::same_measurements(read_packet(file), test::sample_measurements()));
}

TEST(Kinect2Packet, ThatIsMissingAFolderOrOfAnotherSizeIsNamed) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.depth";
  test::expect_part(test::input_error([&] { read_packet(file); }), "a.depth: cannot be read");
  test::expect_part(test::input_error([&] { read_packet(folder.path()); }), "is a folder");
  std::ofstream(file) << "short";
  test::expect_part(test::input_error([&] { read_packet(file); }), "a.depth: a depth packet");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40U);  // sparse, a terabyte
  test::expect_part(test::input_error([&] { read_packet(file); }), "a.depth: a depth packet");
}

}  // namespace
}  // namespace tofmap::kinect2
