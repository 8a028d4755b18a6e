// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/p0_tables.hpp"

#include "binary_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr std::size_t header_bytes = 32;
constexpr std::size_t margin_bytes = 2;  // before and after each table
constexpr std::size_t value_bytes = 2 * image_width_px * image_height_px;
constexpr std::size_t table_bytes = value_bytes + 2 * margin_bytes;
constexpr std::size_t answer_bytes = header_bytes + 3 * table_bytes;
constexpr std::size_t bare_bytes = 3 * value_bytes;

/// The largest answer that libfreenect2 makes room for.
constexpr std::size_t most_p0_bytes = 0x1C0000;

constexpr const char* where_from =
    "the phase offsets of a Kinect v2 are the camera's answer to the request for its P0 tables, "
    "which recording programs keep as calibration/p0.bin; each camera has its own";

ImageU16 table_at(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  ImageU16 table(image_height_px, image_width_px);
  for (Eigen::Index i = 0; i < table.size(); ++i) {
    const std::size_t at = offset + 2 * static_cast<std::size_t>(i);
    table.data()[i] = static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
  }
  return table;
}

/// Throws InputError unless the values may be phases: offsets of a sensor vary from pixel to pixel,
/// and less than unrelated numbers, whose median difference is a quarter of the range of 16 bits.
void check_table(const ImageU16& table, int number, const std::filesystem::path& file) {
  if (table.minCoeff() == table.maxCoeff()) {
    throw InputError(file.string() + ": table " + std::to_string(number) + " is " +
                     std::to_string(table(0, 0)) + " everywhere; " + where_from);
  }
  constexpr int most_difference = 8192;
  std::vector<int> differences;
  for (Eigen::Index row = 0; row < table.rows(); ++row) {
    for (Eigen::Index col = 1; col < table.cols(); ++col) {
      const auto step = static_cast<std::int16_t>(table(row, col) - table(row, col - 1));
      differences.push_back(std::abs(int{step}));
    }
  }
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  if (*middle <= most_difference) return;
  throw InputError(file.string() + ": table " + std::to_string(number) +
                   " holds unrelated numbers, not phase offsets; " + where_from);
}

void append_little_endian(std::vector<std::uint8_t>& bytes, std::size_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

P0Tables read_p0_tables(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) && !unknown) {
    throw InputError(file.string() + ": no such file; " + where_from);
  }
  const std::vector<std::uint8_t> bytes = read_bytes(file, most_p0_bytes);
  const bool is_bare = bytes.size() == bare_bytes;
  if (!is_bare && (bytes.size() < answer_bytes || bytes.size() > most_p0_bytes)) {
    const std::string size = bytes.size() > most_p0_bytes
                                 ? "more than " + std::to_string(most_p0_bytes)
                                 : std::to_string(bytes.size());
    throw InputError(file.string() + ": has " + size + " bytes; expected " +
                     std::to_string(answer_bytes) + " or a little more, or " +
                     std::to_string(bare_bytes) + " without headers; " + where_from);
  }
  P0Tables tables;
  std::size_t offset = is_bare ? 0 : header_bytes + margin_bytes;
  int number = 0;
  for (ImageU16& table : tables.tables) {
    table = table_at(bytes, offset);
    check_table(table, number++, file);
    offset += is_bare ? value_bytes : table_bytes;
  }
  return tables;
}

void write_p0_tables(const std::filesystem::path& file, const P0Tables& tables) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(answer_bytes);
  for (const std::size_t word : {header_bytes, {}, {}, table_bytes, {}, {}, {}, {}}) {
    append_little_endian(bytes, word, 4);
  }
  for (const ImageU16& table : tables.tables) {
    if (table.rows() != image_height_px || table.cols() != image_width_px) {
      throw UsageError("a P0 table has 512 x 424 values, got " + std::to_string(table.cols()) +
                       " x " + std::to_string(table.rows()));
    }
    append_little_endian(bytes, 0, margin_bytes);
    for (const std::uint16_t value : table.reshaped<Eigen::RowMajor>()) {
      append_little_endian(bytes, value, 2);
    }
    append_little_endian(bytes, 0, margin_bytes);
  }
  write_whole(file, bytes);
}

}  // namespace tofmap::kinect2
