// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Throws UsageError if image and rays differ in size. The message begins with `filter`.
inline void check_size(const RangeImage& image, const PixelRays& rays, const std::string& filter) {
  if (same_size(image.range_m, rays.x)) return;
  throw UsageError(filter + ": range image and camera differ in size");
}

}  // namespace tofmap
