// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// A picture whose pixels have the colours `color(row, column)`.
template <class Color>
Picture pixel_picture(Eigen::Index rows, Eigen::Index cols, const Color& color) {
  Picture out(static_cast<int>(cols), static_cast<int>(rows));
  for (int v = 0; v < out.height_px; ++v) {
    for (int u = 0; u < out.width_px; ++u) out.at(u, v) = color(v, u);
  }
  return out;
}

/// The 99.8th percentile of the ranges, rounded up to whole metres. 1 if there are no ranges.
double round_limit_m(const ImageF& range_m);

/// Colours of pixels whose wrap count is right, too small or too large.
namespace wrap_errors {
inline constexpr Rgb none{232, 232, 232};
inline constexpr Rgb too_near{0, 90, 181};
inline constexpr Rgb too_far{220, 120, 0};
}  // namespace wrap_errors

/// The colour of the wrap error of a pixel. White if its range or true range is NaN.
Rgb wrap_error_color(float range_m, float truth_m, double wavelength_m);

/// The colour of a removed pixel by reason. The colours stand out from those of ranges.
Rgb reason_color(InvalidReason reason);

}  // namespace tofmap
