// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "legacy_vtk.hpp"

#include "cloud_headers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Decode = double (*)(const char*);

/// A number in big-endian byte order.
template <class Number>
double decoded(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  std::array<char, sizeof(Number)> reversed;
  std::reverse_copy(bytes, bytes + sizeof(Number), reversed.begin());
  Number value;
  std::memcpy(&value, reversed.data(), sizeof(value));
  return static_cast<double>(value);
}

/// A type of number in a binary file.
struct NumberType {
  std::string_view name;
  std::size_t bytes;
  Decode decode;
};

template <class Number>
constexpr NumberType number_type(std::string_view name) {
  return {name, sizeof(Number), decoded<Number>};
}

constexpr std::array number_types{
    number_type<float>("float"),           number_type<double>("double"),
    number_type<std::int8_t>("char"),      number_type<std::uint8_t>("unsigned_char"),
    number_type<std::int16_t>("short"),    number_type<std::uint16_t>("unsigned_short"),
    number_type<std::int32_t>("int"),      number_type<std::uint32_t>("unsigned_int"),
    number_type<std::int64_t>("long"),     number_type<std::uint64_t>("unsigned_long"),
    number_type<std::int64_t>("vtkIdType")};

/// The line `POINTS n type`.
struct PointsHeader {
  std::size_t count;
  std::string type;
};

/// Reads on to the POINTS section. Empty if there is none.
std::optional<PointsHeader> find_points(std::istream& in) {
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string keyword;
    std::int64_t count = 0;
    PointsHeader header;
    if (!(words >> keyword) || keyword != "POINTS") continue;
    if (!(words >> count >> header.type) || count < 0) {
      throw InputError("has a damaged line '" + line.substr(0, 60) + "'");
    }
    header.count = static_cast<std::size_t>(count);
    return header;
  }
  return std::nullopt;
}

/// The numbers of an ASCII file; fewer if the text ends, or is no number.
std::vector<double> read_text(std::istream& in, std::size_t count) {
  std::vector<double> numbers;
  for (std::string word; numbers.size() < count && in >> word;) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) break;
    numbers.push_back(number);
  }
  return numbers;
}

/// The numbers of a binary file; fewer if the file ends.
std::vector<double> read_binary(std::istream& in, std::size_t count, const NumberType& type) {
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  const std::size_t stored = std::min(count, bytes.size() / type.bytes);
  std::vector<double> numbers(stored);
  for (std::size_t i = 0; i < stored; ++i) numbers[i] = type.decode(&bytes[i * type.bytes]);
  return numbers;
}

}  // namespace

std::vector<Eigen::Vector3d> read_legacy_vtk(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string version;
  std::string title;
  std::string encoding;
  if (!std::getline(in, version) || !version.starts_with("# vtk DataFile")) {
    throw InputError("is no legacy VTK file");
  }
  std::getline(in, title);
  in >> encoding;
  const std::optional<PointsHeader> header = find_points(in);
  if (!header) return {};
  const auto type = std::ranges::find(number_types, header->type, &NumberType::name);
  const bool is_binary = encoding == "BINARY";
  if (is_binary && type == number_types.end()) {
    throw InputError("has points of an unknown type, '" + header->type.substr(0, 60) + "'");
  }
  // No number takes less than a byte.
  if (header->count > std::filesystem::file_size(file) / 3) fail_as_cut_off(header->count);
  const std::size_t count = 3 * header->count;
  const std::vector<double> numbers =
      is_binary ? read_binary(in, count, *type) : read_text(in, count);
  if (numbers.size() < count) fail_as_cut_off(header->count);
  std::vector<Eigen::Vector3d> positions(header->count);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  return positions;
}

}  // namespace tofmap
