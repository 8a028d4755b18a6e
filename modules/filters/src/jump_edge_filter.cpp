// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/jump_edge_filter.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

Eigen::Vector3f ray_at(const PixelRays& rays, Eigen::Index row, Eigen::Index col) {
  return {rays.x(row, col), rays.y(row, col), rays.z(row, col)};
}

struct EdgeLimits {
  float min_cos;          ///< of the angle at the point
  float min_gap_sigmas2;  ///< squared
};

/// Whether some neighbour lies behind the pixel according to the limits.
bool has_neighbour_behind(const RangeImage& image, const PixelRays& rays, Eigen::Index row,
                          Eigen::Index col, const EdgeLimits& limits) {
  const Eigen::Vector3f ray = ray_at(rays, row, col);
  const Eigen::Vector3f point = image.range_m(row, col) * ray;
  for (Eigen::Index r = std::max<Eigen::Index>(0, row - 1);
       r <= std::min(image.rows() - 1, row + 1); ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, col - 1);
         c <= std::min(image.cols() - 1, col + 1); ++c) {
      if ((r == row && c == col) || !image.valid(r, c)) continue;
      const Eigen::Vector3f line = image.range_m(r, c) * ray_at(rays, r, c) - point;
      const auto variance_m2 =
          static_cast<float>(image.variance_m2(r, c) + image.variance_m2(row, col));
      const float gap2 = line.squaredNorm();
      if (gap2 > limits.min_gap_sigmas2 * variance_m2 &&
          -ray.dot(line) < limits.min_cos * std::sqrt(gap2)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

RangeImage drop_jump_edges(const RangeImage& image, const PixelRays& rays, double max_angle_rad,
                           double min_gap_sigmas) {
  check_size(image, rays, "jump-edge filter");
  const EdgeLimits limits{static_cast<float>(std::cos(max_angle_rad)),
                          static_cast<float>(min_gap_sigmas * min_gap_sigmas)};
  RangeImage out = image;
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (image.valid(row, col) && has_neighbour_behind(image, rays, row, col, limits)) {
        out.invalidate(row, col, InvalidReason::jump_edge);
      }
    }
  }
  return out;
}

}  // namespace tofmap
