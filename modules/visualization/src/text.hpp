// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace tofmap {

/// A number with at most four significant digits and no trailing zeros: 2.5, 10, -0.25.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

/// The font size of all texts in pictures.
inline constexpr int text_size_px = 18;

}  // namespace tofmap
