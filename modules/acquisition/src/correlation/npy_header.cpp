// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "npy_header.hpp"

#include <charconv>
#include <limits>
#include <string_view>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";

/// Longest header that is read. Numpy writes 128 bytes for the types that are allowed here.
constexpr std::size_t longest_header = 1 << 20;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("has a damaged .npy header: " + what);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// The text after "'key':" in the header, which is a Python dictionary.
std::string_view after_key(std::string_view header, const std::string& key) {
  for (const char quote : {'\'', '"'}) {
    const std::size_t found = header.find(quote + key + quote);
    if (found == std::string_view::npos) continue;
    std::string_view rest = header.substr(found + key.size() + 2);
    rest = trimmed(rest);
    if (!rest.starts_with(':')) break;
    return trimmed(rest.substr(1));
  }
  refuse("it has no key '" + key + "'");
}

ElementType type_in(std::string_view header) {
  const std::string_view value = after_key(header, "descr");
  constexpr const char* allowed =
      "; allowed: arrays of unsigned or signed integers of 1, 2, 4 or 8 bytes, or of "
      "floating-point "
      "numbers of 4 or 8 bytes";
  if (!value.starts_with('\'') && !value.starts_with('"')) {
    throw InputError(std::string("holds structures, not numbers") + allowed);
  }
  const std::size_t end = value.find(value[0], 1);
  if (end == std::string_view::npos) refuse("its type has no end");
  const std::string_view name = value.substr(1, end - 1);
  const std::optional<ElementType> type = element_type_of_numpy(name);
  if (!type) throw InputError("has elements of type '" + std::string(name) + "'" + allowed);
  return *type;
}

bool fortran_order_in(std::string_view header) {
  const std::string_view value = after_key(header, "fortran_order");
  if (value.starts_with("True")) return true;
  if (value.starts_with("False")) return false;
  refuse("fortran_order is neither True nor False");
}

std::vector<std::int64_t> shape_in(std::string_view header) {
  std::string_view rest = after_key(header, "shape");
  const std::size_t end = rest.find(')');
  if (!rest.starts_with('(') || end == std::string_view::npos) refuse("its shape is no tuple");
  rest = trimmed(rest.substr(1, end - 1));
  std::vector<std::int64_t> shape;
  std::int64_t elements = 1;
  while (!rest.empty()) {
    std::int64_t size = 0;
    const auto [next, error] = std::from_chars(rest.data(), rest.data() + rest.size(), size);
    if (error != std::errc() || size < 1) refuse("its shape has a size that is no number above 0");
    if (elements > std::numeric_limits<std::int64_t>::max() / 8 / size) {
      refuse("its shape has more elements than any file");
    }
    elements *= size;
    shape.push_back(size);
    rest = trimmed(rest.substr(static_cast<std::size_t>(next - rest.data())));
    if (rest.empty()) break;
    if (!rest.starts_with(',')) refuse("its shape has a size that is no number above 0");
    rest = trimmed(rest.substr(1));
  }
  return shape;
}

/// The number that is stored in the bytes, little-endian.
std::size_t length_of(const std::string& bytes) {
  std::size_t length = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    length = 256 * length + static_cast<unsigned char>(bytes[i]);
  }
  return length;
}

}  // namespace

NpyHeader read_npy_header(const std::function<std::string(std::size_t bytes)>& read) {
  const std::string start = read(npy_magic.size() + 2);
  if (!start.starts_with(npy_magic)) {
    throw InputError("is not a .npy file: it does not begin with \\x93NUMPY");
  }
  if (start.size() < npy_magic.size() + 2) refuse("the file ends in it");
  const int version = static_cast<unsigned char>(start[npy_magic.size()]);
  if (version < 1 || version > 3) {
    throw InputError("has version " + std::to_string(version) +
                     " of the .npy format; versions 1 to 3 can be read");
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  const std::string length_text = read(length_bytes);
  const std::size_t length = length_of(length_text);
  if (length_text.size() < length_bytes) refuse("the file ends in it");
  if (length > longest_header) refuse("it is longer than a megabyte");
  const std::string header = read(length);
  if (header.size() < length) refuse("the file ends in it");
  NpyHeader result;
  result.type = type_in(header);
  result.shape = shape_in(header);
  result.fortran_order = fortran_order_in(header);
  result.data_offset = static_cast<std::int64_t>(start.size() + length_bytes + length);
  return result;
}

}  // namespace tofmap
