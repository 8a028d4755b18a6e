// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/core/image.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tofmap {

/// The quantile of the finite pixels of an image for `share` in [0, 1]. Empty if no pixel is
/// finite.
inline std::optional<float> finite_quantile(const ImageF& image, double share) {
  std::vector<float> values;
  for (const float value : image.reshaped()) {
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return std::nullopt;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace tofmap
