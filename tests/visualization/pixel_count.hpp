// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <tofmap/visualization/picture.hpp>

namespace tofmap::test {

inline constexpr Rgb red{255, 0, 0};

/// The number of pixels of a colour.
inline int count(const Picture& picture, Rgb color) {
  return static_cast<int>(std::ranges::count(picture.pixels, color));
}

}  // namespace tofmap::test
