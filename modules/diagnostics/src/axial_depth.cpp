// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/axial_depth.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/camera.hpp>

namespace tofmap {
namespace {

/// Counts phases of one frequency just before and beyond the cosine of the pixel's ray, at which
/// phases computed from depth end.
struct EndOfCycle {
  int all = 0;
  int before = 0;
  int beyond = 0;

  /// Adds an image. Pixels whose rays are close to the optical axis are left out.
  void add(const ImageF& phase, const ImageF& cosine) {
    constexpr float most_cosine = 0.93F;
    constexpr float near_end = 0.93F;
    constexpr float rounding = 0.005F;  // depth in whole millimetres; inexact intrinsics
    for (Eigen::Index i = 0; i < phase.size(); ++i) {
      if (!(cosine.data()[i] < most_cosine)) continue;
      const float share = phase.data()[i] / cosine.data()[i];
      all += std::isnan(share) ? 0 : 1;
      before += share >= near_end && share <= 1 - rounding ? 1 : 0;
      beyond += share >= 1 + rounding ? 1 : 0;
    }
  }

  /// Whether phases end at the cosine. If they did not, about as many phases would lie beyond it as
  /// before it.
  bool is_there() const {
    constexpr int enough = 300;
    constexpr int some = 50;  // a smaller share than 1 / 50 may come from a single object
    return before >= enough && before * some >= all && beyond * some <= before;
  }
};

}  // namespace

bool looks_like_axial_depth(const std::vector<Frame>& frames, const SensorModel& sensor) {
  const ImageF cosine = pixel_rays(sensor.camera).z;
  std::vector<EndOfCycle> ends(sensor.modulation.count());
  for (const Frame& frame : frames) {
    for (std::size_t f = 0; f < frame.frequencies(); ++f) ends[f].add(frame.phases[f], cosine);
  }
  return !ends.empty() && std::ranges::all_of(ends, &EndOfCycle::is_there);
}

std::optional<std::string> axial_depth_warning(const std::vector<Frame>& frames,
                                               const SensorModel& sensor) {
  if (!looks_like_axial_depth(frames, sensor)) return std::nullopt;
  return "towards the border of the image, ranges wrap where depth along the optical axis would; "
         "was depth recorded as if it were range? record again with device.depth=z, which converts "
         "depth to range";
}

}  // namespace tofmap
