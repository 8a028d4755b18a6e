// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// A bend of a range with this noise that is none, metres over four pixels. What a plane seen
/// aslant bends by is left to `is_straight`.
[[gnu::always_inline]] inline float tolerated_bend(float sigma_m) { return 0.08F + 4 * sigma_m; }

/// True if a range rises alike on both sides of a pixel: by `before` up to it, and by `after` from
/// it on. A bend is none up to `tolerated`, and up to this share of what the range rises by.
[[gnu::always_inline]] inline bool is_straight(float before, float after, float tolerated,
                                               float share_of_rise = 0.25F) {
  const float bend = before > after ? before - after : after - before;
  const float rise = before + after > 0 ? before + after : -(before + after);
  const float of_rise = share_of_rise * rise;
  return bend < (tolerated > of_rise ? tolerated : of_rise);
}

/// The slope of A's range along one row of the image, from wrapped phases, so that no wrap count is
/// needed: metres a pixel, and as a gradient on the sphere of rays, metres a radian. 0 where the
/// surface bends or ends, and where noise would make most of it. Neighbours two pixels away decide;
/// at the image's borders, those that there are.
class SurfaceSlopes {
 public:
  SurfaceSlopes(const ExposurePair& pair, const PairGeometry& geometry);

  void find(Eigen::Index row);

  /// Also finds the gradients of the row that was found last.
  void find_gradients(Eigen::Index row);

  std::vector<float> across_m, along_m;  ///< a pixel
  std::vector<float> rough_m;  ///< how steep it is where the surface bends or ends; 0 elsewhere
  std::vector<float> gradient_x, gradient_y, gradient_z;  ///< a radian; 0 without a camera

 private:
  const ExposurePair& pair_;
  const PairGeometry& geometry_;
  // A row with two repeated pixels on both sides.
  std::vector<float> phase_;
  std::vector<float> rays_;  ///< x, y, z of each
};

}  // namespace tofmap
