// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// The bend of a range that is tolerated for noise of this standard deviation: metres, between two
/// differences over two pixels each. Planes that are seen at a slant may bend more; is_straight()
/// tolerates that separately.
[[gnu::always_inline]] inline float tolerated_bend(float sigma_m) { return 0.08F + 4 * sigma_m; }

/// Whether a range rises about equally on both sides of a pixel: by `before` up to the pixel, and
/// by `after` behind it. The two may differ by `tolerated`, or by `share_of_rise` of the total
/// rise, whichever is larger.
[[gnu::always_inline]] inline bool is_straight(float before, float after, float tolerated,
                                               float share_of_rise = 0.25F) {
  const float bend = before > after ? before - after : after - before;
  const float rise = before + after > 0 ? before + after : -(before + after);
  const float of_rise = share_of_rise * rise;
  return bend < (tolerated > of_rise ? tolerated : of_rise);
}

/// The slopes of A's range in one row of the image: in metres per pixel, and as a gradient over the
/// directions of rays, in metres per radian. They are computed from wrapped phases, so that no wrap
/// counts are needed. A slope is 0 where the surface bends or ends, and where noise would dominate
/// it. Slopes are differences between the pixels two pixels away on both sides; at the image's
/// borders, the border pixel is repeated.
class SurfaceSlopes {
 public:
  /// Keeps references to both arguments.
  SurfaceSlopes(const ExposurePair& pair, const PairGeometry& geometry);

  /// Fills in `across_m`, `along_m` and `rough_m` for a row of the image.
  void find(Eigen::Index row);

  /// Fills in the gradients for the row that was passed to find() last. Does nothing if the camera
  /// is unknown.
  void find_gradients(Eigen::Index row);

  std::vector<float> across_m, along_m;  ///< slope per column and per row, metres per pixel
  /// Steepness where the surface bends or ends, metres per pixel; 0 elsewhere.
  std::vector<float> rough_m;
  /// Gradient over ray directions, metres per radian; 0 without a camera.
  std::vector<float> gradient_x, gradient_y, gradient_z;

 private:
  const ExposurePair& pair_;
  const PairGeometry& geometry_;
  // One row, with the border pixel repeated twice on both sides.
  std::vector<float> phase_;
  std::vector<float> rays_;  ///< x of all rays, then y, then z
};

}  // namespace tofmap
