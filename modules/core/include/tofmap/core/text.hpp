// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace tofmap {

/// The words of a range of items, with `separator` between them. `word_of` gives an item's word, as
/// something that a string_view can refer to.
template <class Items, class WordOf = std::identity>
std::string joined(const Items& items, std::string_view separator, WordOf word_of = {}) {
  std::string text;
  for (const auto& item : items) {
    if (!text.empty()) text += separator;
    text += std::string_view(std::invoke(word_of, item));
  }
  return text;
}

/// The text with each byte that is not part of valid UTF-8 replaced by U+FFFD. File names of old
/// systems may hold such bytes; JSON and HTML must not.
std::string valid_utf8(std::string_view text);

/// A number and its noun: "1 frame", "2 frames".
inline std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

/// A number and a noun whose plural has no mere s: "1 frequency", "2 frequencies".
inline std::string counted(std::size_t count, std::string_view one, std::string_view several) {
  return std::to_string(count) + " " + std::string(count == 1 ? one : several);
}

}  // namespace tofmap
