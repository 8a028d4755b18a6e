// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/smooth_filter.hpp"

#include "inverse_depth.hpp"

#include <cmath>

namespace tofmap {

RangeImage smooth_ranges(const RangeImage& image, const PixelRays& rays,
                         const SmoothLimits& limits) {
  const InverseDepth smooth =
      averaged_over_pairs(InverseDepth(image, rays),
                          {.max_sigmas = limits.max_sigmas, .tolerance_m = limits.tolerance_m});
  RangeImage out = image;
  for (int v = 0; v < smooth.rows(); ++v) {
    for (int u = 0; u < smooth.cols(); ++u) {
      if (!image.valid(v, u) || image.averaged(v, u) > 1) continue;
      out.range_m(v, u) = 1 / (smooth.value(v)[u] * rays.z(v, u));
      out.sigma_m(v, u) = std::sqrt(smooth.variance(v)[u]) / rays.z(v, u);
    }
  }
  return out;
}

}  // namespace tofmap
