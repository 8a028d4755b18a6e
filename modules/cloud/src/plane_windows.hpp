// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plane_fit.hpp"

#include <cstdint>
#include <vector>

namespace tofmap {

/// Plane fits whose windows grow with the noise.
///
/// The window of a pixel starts with `window_radius_px`. The radius is doubled, up to
/// `max_window_radius_px`, until the noise of the pixel alone leaves the normal as certain as
/// `max_normal_sigma_rad`, assuming a full window on a plane seen head on. Windows do not average
/// noise that neighbouring pixels share (RangeImage::averaged_px); it is treated as independent
/// noise whose variance is larger by that factor.
class PlaneWindows {
 public:
  PlaneWindows(const RangeImage& image, const PixelRays& rays, const CloudOptions& options);

  /// Like PlaneFits::fit(), with the window of each pixel. May be called by several threads.
  void fit(int row, PlaneRow& out) const;

  float tangent_x(int row, int col) const { return fits_.front().tangent_x(row, col); }
  float tangent_y(int row, int col) const { return fits_.front().tangent_y(row, col); }

 private:
  void take_wider(int row, std::size_t widenings, const PlaneRow& wider, PlaneRow& out) const;
  void count_shared_noise(int row, PlaneRow& out) const;

  int cols_;
  std::vector<PlaneFits> fits_;  ///< by number of doublings, up to the largest number needed
  ImageU8 widenings_;            ///< number of doublings of each pixel's radius
  ImageF averaged_px_;           ///< RangeImage::averaged_px; empty if no pixel was averaged
  ImageF relative_variance_;     ///< (σ / r)² of ranges; empty if no pixel was averaged
};

}  // namespace tofmap
