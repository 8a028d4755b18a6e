// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <tofmap/core/text.hpp>

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
  return joined(named_values(Enum{}), separator, &NamedValue<Enum>::name);
}

/// The names of some values of an enumeration, with `separator` between them.
template <class Enum>
std::string joined_names(const std::vector<Enum>& values, std::string_view separator) {
  return joined(values, separator, name_of<Enum>);
}

/// The values whose names are the words of a text, in its order. Words are separated by white
/// space. Empty if a word is not the name of a value.
template <class Enum>
std::optional<std::vector<Enum>> find_all_named(std::string_view text) {
  std::vector<Enum> values;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::optional<Enum> value = find_named<Enum>(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

}  // namespace tofmap
