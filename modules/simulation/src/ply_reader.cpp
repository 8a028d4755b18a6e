// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_readers.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <vector>

namespace tofmap {
namespace {

enum class Format { ascii, little_endian, big_endian };

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  const char* name;
  Type type;
};

constexpr TypeName type_names[] = {
    {"char", Type::int8},       {"uchar", Type::uint8},    {"short", Type::int16},
    {"ushort", Type::uint16},   {"int", Type::int32},      {"uint", Type::uint32},
    {"float", Type::float32},   {"double", Type::float64}, {"int8", Type::int8},
    {"uint8", Type::uint8},     {"int16", Type::int16},    {"uint16", Type::uint16},
    {"int32", Type::int32},     {"uint32", Type::uint32},  {"float32", Type::float32},
    {"float64", Type::float64},
};

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< type of the length of a list; empty if it is not a list
};

struct Element {
  std::string name;
  long count = 0;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes before the data
};

Type parse_type(const std::string& word, const std::filesystem::path& file) {
  for (const TypeName& candidate : type_names) {
    if (word == candidate.name) return candidate.type;
  }
  fail_to_read(file, "its header has a property of unknown type '" + word + "'");
}

Format parse_format(const std::string& word, const std::filesystem::path& file) {
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little_endian;
  if (word == "binary_big_endian") return Format::big_endian;
  fail_to_read(file, "has the unknown PLY format '" + word + "'");
}

Header read_header(const std::string& bytes, const std::filesystem::path& file) {
  Header header;
  std::istringstream in(bytes);
  std::string line;
  bool any_format = false;
  std::getline(in, line);
  if (!line.starts_with("ply")) fail_to_read(file, "is not a PLY file");
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string key;
    std::string first;
    words >> key >> first;
    if (key == "end_header") {
      if (!any_format) fail_to_read(file, "its header states no format");
      header.size = in.eof() ? bytes.size() : static_cast<std::size_t>(in.tellg());
      return header;
    }
    if (key == "format") {
      header.format = parse_format(first, file);
      any_format = true;
    } else if (key == "element") {
      Element element{first, -1, {}};
      words >> element.count;
      if (!words || element.count < 0) fail_to_read(file, "'" + line + "' has no count");
      header.elements.push_back(element);
    } else if (key == "property") {
      if (header.elements.empty()) fail_to_read(file, "a property comes before any element");
      Property property;
      if (first == "list") {
        std::string count_type;
        words >> count_type >> first;
        property.count_type = parse_type(count_type, file);
      }
      property.type = parse_type(first, file);
      words >> property.name;
      header.elements.back().properties.push_back(property);
    }
  }
  fail_to_read(file, "is cut off: its header has no end");
}

/// Reads the data after the header, number by number. Throws InputError if the file ends too early.
class Numbers {
 public:
  Numbers(const std::string& bytes, const Header& header, const std::filesystem::path& file)
      : at_(bytes.data() + header.size),
        end_(bytes.data() + bytes.size()),
        format_(header.format),
        file_(file) {}

  double next(Type type) { return format_ == Format::ascii ? next_text() : next_binary(type); }

 private:
  double next_text() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
    if (at_ == end_) fail_to_read(file_, "is cut off: it has less data than its header states");
    double number = 0;
    const auto [rest, error] = std::from_chars(at_, end_, number);
    if (error != std::errc()) fail_to_read(file_, "contains data that is not a number");
    at_ = rest;
    return number;
  }

  double next_binary(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::float32:
        return take<float>();
      case Type::float64:
        return take<double>();
    }
    fail_to_read(file_, "has a property of an unknown type");
  }

  template <class T>
  double take() {
    std::array<char, sizeof(T)> raw{};
    if (end_ - at_ < static_cast<std::ptrdiff_t>(sizeof(T))) {
      fail_to_read(file_, "is cut off: it has less data than its header states");
    }
    std::copy_n(at_, sizeof(T), raw.begin());
    at_ += sizeof(T);
    const bool file_is_little = format_ == Format::little_endian;
    if (file_is_little != (std::endian::native == std::endian::little)) std::ranges::reverse(raw);
    return static_cast<double>(std::bit_cast<T>(raw));
  }

  const char* at_;
  const char* end_;
  Format format_;
  std::filesystem::path file_;
};

void read_vertex(const Element& element, Numbers& numbers, TriangleMesh& mesh) {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  double colour_sum = 0;
  int colours = 0;
  for (const Property& property : element.properties) {
    if (property.count_type) {
      for (double left = numbers.next(*property.count_type); left >= 1; --left) {
        numbers.next(property.type);
      }
      continue;
    }
    const double value = numbers.next(property.type);
    if (property.name == "x") point.x() = static_cast<float>(value);
    if (property.name == "y") point.y() = static_cast<float>(value);
    if (property.name == "z") point.z() = static_cast<float>(value);
    if (property.name == "red" || property.name == "green" || property.name == "blue") {
      // Integer colours go up to 255, floating-point colours up to 1.
      const bool whole = property.type != Type::float32 && property.type != Type::float64;
      colour_sum += whole ? value / 255 : value;
      ++colours;
    }
  }
  mesh.vertices.push_back(point);
  const double reflectance = colours > 0 ? colour_sum / colours : unknown_reflectance;
  mesh.reflectance.push_back(static_cast<float>(std::clamp(reflectance, 0.0, 1.0)));
}

/// Reads one element that is not a vertex, and returns its property of vertex indices. Empty if it
/// has no such property.
std::vector<long> read_lists(const Element& element, Numbers& numbers) {
  std::vector<long> corners;
  for (const Property& property : element.properties) {
    const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
    const double count = property.count_type ? numbers.next(*property.count_type) : 1;
    for (double i = 0; i < count; ++i) {
      const double value = numbers.next(property.type);
      // add_polygon() reports −1 as an invalid vertex.
      if (is_corners)
        corners.push_back(value >= 0 && value < 0x1p32 ? static_cast<long>(value) : -1);
    }
  }
  return corners;
}

}  // namespace

TriangleMesh read_ply_mesh(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  const Header header = read_header(bytes, file);
  Numbers numbers(bytes, header, file);
  TriangleMesh mesh;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;  // has no data, whatever its count
    for (long i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        read_vertex(element, numbers, mesh);
      } else {
        const std::vector<long> corners = read_lists(element, numbers);
        if (element.name == "face") add_polygon(mesh, corners, file);
      }
    }
  }
  return mesh;
}

}  // namespace tofmap
