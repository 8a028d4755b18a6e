// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace tofmap {

/// Words in a row, with `separator` between them.
template <class Words>
std::string joined(const Words& words, std::string_view separator) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

/// The same text where it is valid UTF-8; each byte that is not, as in names of files of old
/// systems, becomes U+FFFD. What goes into JSON or HTML must be valid.
std::string valid_utf8(std::string_view text);

/// "1 frame", "2 frames".
inline std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace tofmap
