// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/packet.hpp"

#include "binary_file.hpp"

#include <algorithm>
#include <string>

#include <tofmap/acquisition/kinect2/companding.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr int code_bits = 11;
constexpr std::size_t row_bytes = image_width_px * code_bits / 8;
constexpr std::size_t sub_image_bytes = row_bytes * image_height_px;
static_assert(packet_bytes == 10 * sub_image_bytes);

/// The bytes of a row and one more, so that the last code can be accessed as three bytes, like all
/// others.
using PaddedRow = std::array<std::uint8_t, row_bytes + 1>;

/// Position of a code in a row: its first byte, and the number of bits before it in that byte.
struct CodePlace {
  std::size_t byte;
  int shift;
};

CodePlace place_of_column(int u) {
  const int bit = code_bits * ((u >> 2) + ((u & 3) << 7));
  return {static_cast<std::size_t>(bit / 8), bit % 8};
}

std::array<CodePlace, image_width_px> places_of_columns() {
  std::array<CodePlace, image_width_px> places{};
  for (int u = 0; u < image_width_px; ++u) places[u] = place_of_column(u);
  return places;
}

std::array<std::int16_t, code_count> measurements_of_codes() {
  std::array<std::int16_t, code_count> measurements{};
  for (int code = 0; code < code_count; ++code) measurements[code] = measurement_of_code(code);
  return measurements;
}

/// Offset of an image row in its sub-image.
std::size_t row_offset(int v) {
  constexpr int half = image_height_px / 2;
  const int stored_row = v < half ? v : image_height_px - 1 + half - v;
  return stored_row * row_bytes;
}

/// The columns that hold measurements: all but the first and the last one.
constexpr int first_column = 1;
constexpr int end_column = image_width_px - 1;

Image<std::int16_t> decode_sub_image(std::span<const std::uint8_t> bytes) {
  static const auto places = places_of_columns();
  static const auto measurements = measurements_of_codes();
  Image<std::int16_t> image = Image<std::int16_t>::Zero(image_height_px, image_width_px);
  PaddedRow row{};
  for (int v = 0; v < image_height_px; ++v) {
    std::ranges::copy(bytes.subspan(row_offset(v), row_bytes), row.begin());
    for (int u = first_column; u < end_column; ++u) {
      const auto [byte, shift] = places[u];
      const int bits = row[byte] | row[byte + 1] << 8 | row[byte + 2] << 16;
      image(v, u) = measurements[(bits >> shift) % code_count];
    }
  }
  return image;
}

void encode_sub_image(const Image<std::int16_t>& image, std::span<std::uint8_t> bytes) {
  static const auto places = places_of_columns();
  for (int v = 0; v < image_height_px; ++v) {
    PaddedRow row{};
    for (int u = first_column; u < end_column; ++u) {
      const auto [byte, shift] = places[u];
      const int bits = nearest_code(image(v, u)) << shift;
      for (int i = 0; i < 3; ++i) {
        row[byte + i] = static_cast<std::uint8_t>(row[byte + i] | (bits >> (8 * i)));
      }
    }
    std::copy_n(row.begin(), row_bytes, bytes.begin() + row_offset(v));
  }
}

}  // namespace

Measurements decode_packet(std::span<const std::uint8_t> packet) {
  if (packet.size() != packet_bytes) {
    throw InputError("a depth packet of a Kinect v2 has " + std::to_string(packet_bytes) +
                     " bytes, but this one has " + std::to_string(packet.size()));
  }
  Measurements measurements;
  std::size_t offset = 0;
  for (Steps& steps : measurements.steps) {
    for (Image<std::int16_t>& image : steps) {
      image = decode_sub_image(packet.subspan(offset, sub_image_bytes));
      offset += sub_image_bytes;
    }
  }
  return measurements;
}

std::vector<std::uint8_t> encode_packet(const Measurements& measurements) {
  std::vector<std::uint8_t> packet(packet_bytes);
  std::size_t offset = 0;
  for (const Steps& steps : measurements.steps) {
    for (const Image<std::int16_t>& image : steps) {
      if (image.rows() != image_height_px || image.cols() != image_width_px) {
        throw UsageError("a measurement of a Kinect v2 has 512 x 424 pixels, got " +
                         std::to_string(image.cols()) + " x " + std::to_string(image.rows()));
      }
      encode_sub_image(image, std::span(packet).subspan(offset, sub_image_bytes));
      offset += sub_image_bytes;
    }
  }
  return packet;
}

Measurements read_packet(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> packet = read_bytes(file, packet_bytes);
  return naming(file.string(), [&] { return decode_packet(packet); });
}

}  // namespace tofmap::kinect2
