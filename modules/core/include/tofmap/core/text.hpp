// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tofmap {

/// The words, with `separator` between them.
template <class Words>
std::string joined(const Words& words, std::string_view separator) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += separator;
    text += word;
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

}  // namespace tofmap
