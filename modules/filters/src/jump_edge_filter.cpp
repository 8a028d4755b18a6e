// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/jump_edge_filter.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

Eigen::Vector3f ray_at(const PixelRays& rays, Eigen::Index row, Eigen::Index col) {
  return {rays.x(row, col), rays.y(row, col), rays.z(row, col)};
}

/// True if some neighbour's angle exceeds the threshold, given by its cosine.
bool has_neighbour_behind(const RangeImage& image, const PixelRays& rays, Eigen::Index row,
                          Eigen::Index col, float min_cos) {
  const Eigen::Vector3f ray = ray_at(rays, row, col);
  const Eigen::Vector3f point = image.range_m(row, col) * ray;
  for (Eigen::Index r = std::max<Eigen::Index>(0, row - 1);
       r <= std::min(image.rows() - 1, row + 1); ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, col - 1);
         c <= std::min(image.cols() - 1, col + 1); ++c) {
      if ((r == row && c == col) || !image.valid(r, c)) continue;
      const Eigen::Vector3f line = image.range_m(r, c) * ray_at(rays, r, c) - point;
      if (-ray.dot(line) < min_cos * line.norm()) return true;
    }
  }
  return false;
}

}  // namespace

RangeImage drop_jump_edges(const RangeImage& image, const PixelRays& rays, double max_angle_rad) {
  if (!same_size(image.range_m, rays.x)) {
    throw UsageError("jump-edge filter: range image and camera differ in size");
  }
  const auto min_cos = static_cast<float>(std::cos(max_angle_rad));
  RangeImage out = image;
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (image.valid(row, col) && has_neighbour_behind(image, rays, row, col, min_cos)) {
        out.invalidate(row, col, InvalidReason::jump_edge);
      }
    }
  }
  return out;
}

}  // namespace tofmap
