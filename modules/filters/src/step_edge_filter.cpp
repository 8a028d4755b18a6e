// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/step_edge_filter.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tofmap {
namespace {

/// Offset to a neighbour, pixels.
struct Offset {
  Eigen::Index rows;
  Eigen::Index cols;
};

class StepFinder {
 public:
  StepFinder(const RangeImage& image, const PixelRays& rays, const StepEdgeLimits& limits)
      : image_(image),
        rays_(rays),
        slope_(static_cast<float>(std::tan(limits.max_incidence_deg * std::numbers::pi / 180))),
        sigmas_(static_cast<float>(limits.min_sigmas)) {}

  bool is_between_steps(Eigen::Index row, Eigen::Index col) const {
    constexpr std::array<Offset, 4> directions{{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
    for (const Offset& to : directions) {
      const int one = step(row, col, row + to.rows, col + to.cols);
      const int other = step(row, col, row - to.rows, col - to.cols);
      if (one * other < 0) return true;
    }
    return false;
  }

 private:
  /// 1 if the neighbour (r, c) is behind the pixel by a step, −1 if it is in front of it by a step,
  /// 0 if there is no step between them or no valid neighbour.
  int step(Eigen::Index row, Eigen::Index col, Eigen::Index r, Eigen::Index c) const {
    const bool is_inside = r >= 0 && r < image_.rows() && c >= 0 && c < image_.cols();
    if (!is_inside || !image_.valid(r, c)) return 0;
    const float own_m = image_.range_m(row, col);
    const float other_m = image_.range_m(r, c);
    const float spacing_rad =
        std::hypot(rays_.x(r, c) - rays_.x(row, col), rays_.y(r, c) - rays_.y(row, col),
                   rays_.z(r, c) - rays_.z(row, col));
    const auto error_m =
        static_cast<float>(std::sqrt(image_.variance_m2(row, col) + image_.variance_m2(r, c)));
    const float least_m = slope_ * spacing_rad * std::min(own_m, other_m) + sigmas_ * error_m;
    const float difference_m = other_m - own_m;
    if (std::abs(difference_m) <= least_m) return 0;
    return difference_m > 0 ? 1 : -1;
  }

  const RangeImage& image_;
  const PixelRays& rays_;
  float slope_;  ///< largest ratio of range difference and arc between two pixels of a surface
  float sigmas_;
};

}  // namespace

RangeImage drop_steps(const RangeImage& image, const PixelRays& rays,
                      const StepEdgeLimits& limits) {
  check_size(image, rays, "step-edge filter");
  const StepFinder finder(image, rays, limits);
  RangeImage out = image;
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (image.valid(row, col) && finder.is_between_steps(row, col)) {
        out.invalidate(row, col, InvalidReason::jump_edge);
      }
    }
  }
  return out;
}

}  // namespace tofmap
