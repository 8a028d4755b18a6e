// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plane_fit.hpp"

#include <cstdint>
#include <vector>

namespace tofmap {

/// Plane fits whose windows grow with the noise.
///
/// A pixel's window has the options' radius. Where even a full one, seen head on, would leave the
/// normal less certain than the options allow, by the pixel's noise alone, its radius doubles, and
/// doubles again, up to the options' largest. Noise that pixels share (RangeImage::averaged_px) is
/// not averaged by windows within what they share it over: it counts as noise of single pixels of
/// that much more variance.
class PlaneWindows {
 public:
  PlaneWindows(const RangeImage& image, const PixelRays& rays, const CloudOptions& options);

  /// As PlaneFits::fit(). Rows may be fitted by several threads.
  void fit(int row, PlaneRow& out) const;

  float tangent_x(int row, int col) const { return fits_.front().tangent_x(row, col); }
  float tangent_y(int row, int col) const { return fits_.front().tangent_y(row, col); }

 private:
  void take_wider(int row, std::size_t widenings, const PlaneRow& wider, PlaneRow& out) const;
  void count_shared_noise(int row, PlaneRow& out) const;

  int cols_;
  std::vector<PlaneFits> fits_;  ///< of each radius that a pixel needs, the smallest first
  ImageU8 widenings_;            ///< which of them is a pixel's; empty: the first for all
  ImageF averaged_px_;           ///< empty: pixels are by themselves
  ImageF relative_variance_;     ///< of ranges, (σ / r)², if they are averaged
};

}  // namespace tofmap
