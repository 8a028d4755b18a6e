// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/element_type.hpp"

namespace tofmap {
namespace {

std::optional<ElementType::Kind> kind_of(std::string_view name) {
  if (name == "uint" || name == "u") return ElementType::Kind::unsigned_integer;
  if (name == "int" || name == "i") return ElementType::Kind::signed_integer;
  if (name == "float" || name == "f") return ElementType::Kind::floating_point;
  return std::nullopt;
}

std::optional<ElementType> element_type(std::string_view kind_name, int bytes, bool big_endian) {
  const std::optional<ElementType::Kind> kind = kind_of(kind_name);
  if (!kind) return std::nullopt;
  const bool is_float = *kind == ElementType::Kind::floating_point;
  const bool is_known = bytes == 4 || bytes == 8 || (!is_float && (bytes == 1 || bytes == 2));
  if (!is_known) return std::nullopt;
  return ElementType{*kind, bytes, big_endian};
}

}  // namespace

std::optional<ElementType> element_type_named(std::string_view name) {
  const std::size_t digits = name.find_first_of("0123456789");
  if (digits == std::string_view::npos) return std::nullopt;
  const std::string_view bits = name.substr(digits);
  const int bytes = bits == "8" ? 1 : bits == "16" ? 2 : bits == "32" ? 4 : bits == "64" ? 8 : 0;
  const std::string_view kind = name.substr(0, digits);
  return kind.size() > 1 ? element_type(kind, bytes, false) : std::nullopt;
}

std::optional<ElementType> element_type_of_numpy(std::string_view text) {
  if (text.size() != 3 || text[2] < '1' || text[2] > '8') return std::nullopt;
  const char order = text[0];
  if (order != '<' && order != '>' && order != '=' && order != '|') return std::nullopt;
  const bool native_is_big = std::endian::native == std::endian::big;
  return element_type(text.substr(1, 1), text[2] - '0',
                      order == '>' || (order == '=' && native_is_big));
}

std::string text_of(const ElementType& type) {
  const char* kind = type.kind == ElementType::Kind::unsigned_integer ? "uint"
                     : type.kind == ElementType::Kind::signed_integer ? "int"
                                                                      : "float";
  return kind + std::to_string(8 * type.bytes) +
         (type.bytes == 1   ? ""
          : type.big_endian ? ", big-endian"
                            : ", little-endian");
}

}  // namespace tofmap
