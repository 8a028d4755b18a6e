// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exposure_pair.hpp"

#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// The slope of A's range along one row of the image, from wrapped phases, so that no wrap count is
/// needed: metres a pixel, and as a gradient on the sphere of rays, metres a radian. 0 where the
/// surface bends or ends, and where noise would make most of it. Neighbours two pixels away decide;
/// at the image's borders, those that there are.
class SurfaceSlopes {
 public:
  SurfaceSlopes(const ExposurePair& pair, const PairGeometry& geometry);

  void find(Eigen::Index row);

  std::vector<float> across_m, along_m;                   ///< a pixel
  std::vector<float> gradient_x, gradient_y, gradient_z;  ///< a radian; 0 without a camera

 private:
  const ExposurePair& pair_;
  const PairGeometry& geometry_;
  // Rows with two repeated pixels on both sides.
  std::vector<float> phase_, above_, below_;
  std::vector<float> rays_;  ///< of this row, the one above and the one below: x, y, z of each
};

}  // namespace tofmap
