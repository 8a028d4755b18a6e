// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tofmap {

/// A value of an enumeration and its name in options, reports and messages.
///
/// An enumeration that is used as an option has in its namespace a function
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

}  // namespace tofmap
