// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace tofmap::accuracy {

/// As printf would print it.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[512];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

/// As a share of a hundred: "58 / 60".
inline std::string count_of(int count, int all) { return formatted("%d / %d", count, all); }

}  // namespace tofmap::accuracy
