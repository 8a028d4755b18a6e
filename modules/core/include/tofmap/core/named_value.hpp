// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tofmap {

/// A value of an enumeration with the name that options, reports and messages have for it.
///
/// An enumeration that is an option offers, in its own namespace,
/// `std::span<const NamedValue<Enum>> named_values(Enum)`, with the values in the order in which
/// they are listed to users. The argument only selects the function.
template <class Enum>
struct NamedValue {
  std::string_view name;
  Enum value;
};

/// The name of a value. Empty if it has none.
template <class Enum>
std::string_view name_of(Enum value) {
  for (const NamedValue<Enum>& named : named_values(value)) {
    if (named.value == value) return named.name;
  }
  return {};
}

/// The value of this name. Empty if there is none.
template <class Enum>
std::optional<Enum> find_named(std::string_view name) {
  for (const NamedValue<Enum>& named : named_values(Enum{})) {
    if (named.name == name) return named.value;
  }
  return std::nullopt;
}

/// All names, with `separator` between them.
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
