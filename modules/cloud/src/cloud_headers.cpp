// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_headers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr int most_header_lines = 1000;

[[noreturn]] void fail_as_damaged(const std::string& line) {
  throw InputError("has a damaged header: '" + line.substr(0, 60) + "'");
}

/// The whole number of a header line.
std::int64_t number_of(const std::string& word, const std::string& line, std::int64_t least,
                       std::int64_t most) {
  std::istringstream in(word);
  std::int64_t number = 0;
  if (!(in >> number) || in.peek() != std::char_traits<char>::eof() || number < least ||
      number > most) {
    fail_as_damaged(line);
  }
  return number;
}

constexpr std::int64_t most_points = std::int64_t{1} << 31;  // PCL counts with 32 bits

/// Throws if the file is smaller than a header up to `header_end` and these points.
void check_size(const std::filesystem::path& file, std::streamoff header_end, std::int64_t points,
                std::int64_t bytes_per_point) {
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file));
  const std::int64_t stored = (size - header_end) / std::max<std::int64_t>(1, bytes_per_point);
  if (stored < points) fail_as_cut_off(static_cast<std::size_t>(points));
}

/// The lines of a PCD header by their keyword, without it.
class PcdHeader {
 public:
  explicit PcdHeader(std::istream& in) {
    for (int number = 0; number < most_header_lines && std::getline(in, line_); ++number) {
      std::vector<std::string> words = words_of_line(line_);
      if (words.empty() || words.front().starts_with('#')) continue;
      const std::string keyword = words.front() == "COLUMNS" ? "FIELDS" : words.front();
      words.erase(words.begin());
      lines_[keyword] = std::move(words);
      if (keyword == "DATA") return;
    }
    throw InputError("is no PCD file: its header has no line 'DATA'");
  }

  bool has(const std::string& keyword) const { return lines_.contains(keyword); }

  /// The words of a line; empty if there is none.
  const std::vector<std::string>& words(const std::string& keyword) { return lines_[keyword]; }

  /// The numbers of a line, which must have as many as there are fields; as often `otherwise` if
  /// there is no such line.
  std::vector<std::int64_t> numbers(const std::string& keyword, std::int64_t otherwise,
                                    std::int64_t most) {
    const std::size_t fields = words("FIELDS").size();
    if (!has(keyword)) return std::vector(fields, otherwise);
    std::vector<std::int64_t> found;
    for (const std::string& word : words(keyword)) {
      found.push_back(number_of(word, line_of(keyword), 1, most));
    }
    if (found.size() != fields) fail_as_damaged(line_of(keyword));
    return found;
  }

  /// The number of a line, or `otherwise` if there is no such line.
  std::int64_t number(const std::string& keyword, std::int64_t otherwise) {
    if (!has(keyword)) return otherwise;
    if (words(keyword).size() != 1) fail_as_damaged(line_of(keyword));
    return number_of(words(keyword).front(), line_of(keyword), 0, most_points);
  }

  std::string line_of(const std::string& keyword) {
    std::string line = keyword;
    for (const std::string& word : words(keyword)) line += " " + word;
    return line;
  }

 private:
  std::string line_;
  std::map<std::string, std::vector<std::string>> lines_;
};

/// Bytes of a PLY property of this type; 0 if there is no such type.
std::int64_t bytes_of_ply_type(std::string_view type) {
  using Type = std::pair<std::string_view, std::int64_t>;
  constexpr std::array<Type, 16> types{{{"char", 1},
                                        {"int8", 1},
                                        {"uchar", 1},
                                        {"uint8", 1},
                                        {"short", 2},
                                        {"int16", 2},
                                        {"ushort", 2},
                                        {"uint16", 2},
                                        {"int", 4},
                                        {"int32", 4},
                                        {"uint", 4},
                                        {"uint32", 4},
                                        {"float", 4},
                                        {"float32", 4},
                                        {"double", 8},
                                        {"float64", 8}}};
  const auto* const found = std::ranges::find(types, type, &Type::first);
  return found == types.end() ? 0 : found->second;
}

/// What a PLY header says of its points.
struct PlyHeader {
  bool is_binary = false;
  std::int64_t points = 0;
  std::int64_t bytes_per_point = 0;
};

/// Reads a PLY header up to its end.
PlyHeader read_ply_header(std::istream& in) {
  PlyHeader header;
  std::string element;
  std::string line;
  if (!std::getline(in, line) || !line.starts_with("ply")) {
    throw InputError("is no PLY file: it does not begin with the word ply");
  }
  for (int number = 0; number < most_header_lines && std::getline(in, line); ++number) {
    const std::vector<std::string> words = words_of_line(line);
    if (words.empty()) continue;
    if (words[0] == "end_header") return header;
    if (words[0] == "format" && words.size() > 1) header.is_binary = words[1] != "ascii";
    if (words[0] == "element") {
      if (words.size() != 3) fail_as_damaged(line);
      element = words[1];
      const std::int64_t count = number_of(words[2], line, 0, most_points);
      if (element == "vertex") header.points = count;
    }
    if (words[0] != "property" || element != "vertex") continue;
    if (words.size() < 3) fail_as_damaged(line);
    if (words[1] == "list") {
      throw InputError("has points with a list, '" + line.substr(0, 60) + "'; remove the list");
    }
    const std::int64_t bytes = bytes_of_ply_type(words[1]);
    if (bytes == 0) fail_as_damaged(line);
    header.bytes_per_point += bytes;
  }
  throw InputError("has a damaged header, without a line 'end_header'");
}

}  // namespace

void check_pcd_header(const std::filesystem::path& file) {
  constexpr std::int64_t largest_number = 8;
  constexpr std::int64_t most_in_a_field = 1 << 16;  // histograms have a few hundred
  std::ifstream in(file, std::ios::binary);
  PcdHeader header(in);
  if (header.words("FIELDS").empty()) throw InputError("has a damaged header, without fields");
  const std::vector<std::int64_t> sizes = header.numbers("SIZE", 4, largest_number);
  const std::vector<std::int64_t> counts = header.numbers("COUNT", 1, most_in_a_field);
  if (header.has("TYPE") && header.words("TYPE").size() != sizes.size()) {
    fail_as_damaged(header.line_of("TYPE"));
  }
  const std::int64_t width = header.number("WIDTH", 0);
  const std::int64_t height = header.number("HEIGHT", 1);
  const std::int64_t points = header.number("POINTS", width * height);
  std::int64_t bytes_per_point = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) bytes_per_point += sizes[i] * counts[i];
  const std::vector<std::string>& encoding = header.words("DATA");
  if (!encoding.empty() && encoding.front() == "binary") {
    check_size(file, in.tellg(), points, bytes_per_point);
  }
}

void check_ply_header(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const PlyHeader header = read_ply_header(in);
  if (header.is_binary) check_size(file, in.tellg(), header.points, header.bytes_per_point);
}

void fail_as_cut_off(std::size_t points) {
  throw InputError("is cut off: it should have " + counted(points, "point") +
                   "; copy or export it again");
}

}  // namespace tofmap
