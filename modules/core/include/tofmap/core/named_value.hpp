// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofmap {

/// A value of an enumeration and its name in options, reports and messages.
///
/// An enumeration whose values have names has in its namespace a function
/// `std::span<const NamedValue<Enum>> named_values(Enum)`, which returns the values in the order in
/// which users see them. The argument only selects the overload.
template <class Enum>
struct NamedValue {
  std::string_view name;
  Enum value;
};

/// The name of a value. Empty if the value has no name.
template <class Enum>
std::string_view name_of(Enum value) {
  for (const NamedValue<Enum>& named : named_values(value)) {
    if (named.value == value) return named.name;
  }
  return {};
}

/// The value with this name. Empty if no value has this name.
template <class Enum>
std::optional<Enum> find_named(std::string_view name) {
  for (const NamedValue<Enum>& named : named_values(Enum{})) {
    if (named.name == name) return named.value;
  }
  return std::nullopt;
}

/// The names of all values of an enumeration, with `separator` between them.
template <class Enum>
std::string all_names(std::string_view separator) {
  std::string text;
  for (const NamedValue<Enum>& named : named_values(Enum{})) {
    if (!text.empty()) text += separator;
    text += named.name;
  }
  return text;
}

/// The names of some values of an enumeration, with `separator` between them.
template <class Enum>
std::string joined_names(const std::vector<Enum>& values, std::string_view separator) {
  std::string text;
  for (const Enum value : values) {
    if (!text.empty()) text += separator;
    text += name_of(value);
  }
  return text;
}

/// The values whose names are the words of a text, in its order. Words are separated by white
/// space. Empty if a word is not the name of a value.
template <class Enum>
std::optional<std::vector<Enum>> find_all_named(std::string_view text) {
  constexpr std::string_view white_space = " \t\r\n";
  std::vector<Enum> values;
  for (std::size_t from = text.find_first_not_of(white_space); from != std::string_view::npos;) {
    const std::size_t to = std::min(text.find_first_of(white_space, from), text.size());
    const std::optional<Enum> value = find_named<Enum>(text.substr(from, to - from));
    if (!value) return std::nullopt;
    values.push_back(*value);
    from = text.find_first_not_of(white_space, to);
  }
  return values;
}

}  // namespace tofmap
