// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/camera_warning.hpp"

#include <fmt/format.h>

namespace tofmap {

std::optional<std::string> camera_warning(const CameraModel& camera) {
  constexpr double most_unequal = 1.25;
  const double ratio = camera.fx_px / camera.fy_px;
  if (ratio < most_unequal && ratio > 1 / most_unequal) return std::nullopt;
  return fmt::format(
      "the focal lengths differ by more than a quarter, fx {:.1f} px and fy {:.1f} px; are both "
      "right?",
      camera.fx_px, camera.fy_px);
}

}  // namespace tofmap
