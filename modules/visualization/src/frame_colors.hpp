// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// Every pixel of an image by its colour, as `color(row, column)` gives it.
template <class Color>
Picture pixel_picture(Eigen::Index rows, Eigen::Index cols, const Color& color) {
  Picture out(static_cast<int>(cols), static_cast<int>(rows));
  for (int v = 0; v < out.height_px; ++v) {
    for (int u = 0; u < out.width_px; ++u) out.at(u, v) = color(v, u);
  }
  return out;
}

/// A round number that all but the farthest few of the ranges stay below; 1 if there are none.
double round_limit_m(const ImageF& range_m);

/// How many wraps a pixel is off, and whether it is farther or nearer than the truth.
namespace wrap_errors {
inline constexpr Rgb none{232, 232, 232};
inline constexpr Rgb too_near{0, 90, 181};
inline constexpr Rgb too_far{220, 120, 0};
}  // namespace wrap_errors

/// White where the range or the truth is missing.
Rgb wrap_error_color(float range_m, float truth_m, double wavelength_m);

/// Colours that stand out of those of ranges.
Rgb reason_color(InvalidReason reason);

}  // namespace tofmap
