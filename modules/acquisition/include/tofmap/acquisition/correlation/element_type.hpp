// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace tofmap {

/// The type of the numbers in an array file.
struct ElementType {
  enum class Kind { unsigned_integer, signed_integer, floating_point };
  Kind kind = Kind::unsigned_integer;
  int bytes = 2;  ///< 1, 2, 4 or 8 for integers, 4 or 8 for floating-point numbers
  bool big_endian = false;

  bool is_integer() const { return kind != Kind::floating_point; }
  bool operator==(const ElementType&) const = default;
};

/// The names that element_type_named() knows, for messages.
inline constexpr const char* element_type_names =
    "uint8, uint16, uint32, uint64, int8, int16, int32, int64, float32 or float64";

/// The little-endian type of a name such as "uint16". Empty if the name is unknown.
std::optional<ElementType> element_type_named(std::string_view name);

/// The type of numpy's short form: the byte order (<, >, = or |), the kind (u, i or f) and the
/// number of bytes, as in "<u2". Empty if it is another type, such as an object or a structure.
std::optional<ElementType> element_type_of_numpy(std::string_view text);

/// The name of a type and its byte order, as in "uint16, big-endian".
std::string text_of(const ElementType& type);

/// The number that is stored at `bytes`.
template <class Number>
Number stored_number(const std::byte* bytes, bool big_endian) {
  std::byte copy[sizeof(Number)];
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    copy[i] = bytes[swap ? sizeof(Number) - 1 - i : i];
  }
  Number number;
  std::memcpy(&number, copy, sizeof number);
  return number;
}

/// Calls `visit` with a value-initialised number of the C++ type that `type` describes.
template <class Visit>
void with_number_type(const ElementType& type, const Visit& visit) {
  const auto of_size = [&](auto one, auto two, auto four, auto eight) {
    if (type.bytes == 1) return visit(one);
    if (type.bytes == 2) return visit(two);
    if (type.bytes == 4) return visit(four);
    visit(eight);
  };
  switch (type.kind) {
    case ElementType::Kind::unsigned_integer:
      return of_size(std::uint8_t{}, std::uint16_t{}, std::uint32_t{}, std::uint64_t{});
    case ElementType::Kind::signed_integer:
      return of_size(std::int8_t{}, std::int16_t{}, std::int32_t{}, std::int64_t{});
    case ElementType::Kind::floating_point:
      if (type.bytes == 4) return visit(float{});
      return visit(double{});
  }
}

}  // namespace tofmap
