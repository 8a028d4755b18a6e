// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/outlier_filter.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <tofmap/core/median.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr int window_radius_px = 2;
constexpr std::size_t most_nearest = 6;  // of the 24 around a pixel inside the image
constexpr int least_neighbours = 4;

/// Lower limit of the standard deviation of the spacing: slant alone makes the spacing vary by it.
constexpr float least_deviation = 0.1F;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Pixels of a row, from column `col` on.
struct RowPixels {
  const float* range_m;
  const float* sigma_m;
  const float* ray_x;
  const float* ray_y;
  const float* ray_z;

  RowPixels(const RangeImage& image, const PixelRays& rays, Eigen::Index row, Eigen::Index col)
      : range_m(&image.range_m(row, col)),
        sigma_m(&image.sigma_m(row, col)),
        ray_x(&rays.x(row, col)),
        ray_y(&rays.y(row, col)),
        ray_z(&rays.z(row, col)) {}
};

/// The squared spacing between the points of two rows: their squared distance over the squared
/// distance of two points on a sphere around the camera plus noise (docs/filters.md, equation 8).
/// Infinite where a pixel is invalid. Adds 1 to `neighbours` where both pixels are valid.
TOFMAP_VECTOR_CLONES void find_spacing(int pixels, const RowPixels& own_, const RowPixels& other_,
                                       float* squared, int* neighbours) {
  const RowPixels own = own_;
  const RowPixels other = other_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float x = other.ray_x[i] - own.ray_x[i];
    const float y = other.ray_y[i] - own.ray_y[i];
    const float z = other.ray_z[i] - own.ray_z[i];
    const float angle2 = x * x + y * y + z * z;
    const float step_m = other.range_m[i] - own.range_m[i];
    const float nearer_m = other.range_m[i] < own.range_m[i] ? other.range_m[i] : own.range_m[i];
    const float distance2 = step_m * step_m + own.range_m[i] * other.range_m[i] * angle2;
    const float noise2 = own.sigma_m[i] * own.sigma_m[i] + other.sigma_m[i] * other.sigma_m[i];
    const float ratio = distance2 / (nearer_m * nearer_m * angle2 + noise2);
    const bool is_valid = ratio >= 0;
    squared[i] = is_valid ? ratio : infinity;
    neighbours[i] += is_valid ? 1 : 0;
  }
}

/// One step of an insertion sort: puts the smaller of `smallest` and `values` into `smallest`, and
/// the larger into `values`.
TOFMAP_VECTOR_CLONES void sort_in(int pixels, float* smallest, float* values) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float lesser = values[i] < smallest[i] ? values[i] : smallest[i];
    const float greater = values[i] < smallest[i] ? smallest[i] : values[i];
    smallest[i] = lesser;
    values[i] = greater;
  }
}

/// Mean spacing of each pixel of a row to the nearest quarter of the valid pixels around it.
class RowSpacing {
 public:
  explicit RowSpacing(Eigen::Index cols)
      : values_(static_cast<std::size_t>(cols)), neighbours_(values_.size()) {
    smallest_.fill(values_);
  }

  void find(const RangeImage& image, const PixelRays& rays, Eigen::Index row) {
    for (auto& smallest : smallest_) std::ranges::fill(smallest, infinity);
    std::ranges::fill(neighbours_, 0);
    for (int dv = -window_radius_px; dv <= window_radius_px; ++dv) {
      if (row + dv < 0 || row + dv >= image.rows()) continue;
      for (int du = -window_radius_px; du <= window_radius_px; ++du) {
        if (dv != 0 || du != 0) add(image, rays, row, dv, du);
      }
    }
  }

  /// The mean spacing of a pixel. Infinite if too few pixels around it are valid.
  float mean(Eigen::Index col) const {
    const auto i = static_cast<std::size_t>(col);
    if (neighbours_[i] < least_neighbours) return infinity;
    const auto nearest = static_cast<std::size_t>((neighbours_[i] + 2) / 4);
    float sum = 0;
    for (std::size_t k = 0; k < nearest; ++k) sum += std::sqrt(smallest_[k][i]);
    return sum / static_cast<float>(nearest);
  }

 private:
  void add(const RangeImage& image, const PixelRays& rays, Eigen::Index row, int dv, int du) {
    const Eigen::Index first = std::max(0, -du);
    const auto pixels = static_cast<int>(image.cols() - std::abs(du));
    if (pixels <= 0) return;
    find_spacing(pixels, {image, rays, row, first}, {image, rays, row + dv, first + du},
                 values_.data(), neighbours_.data() + first);
    for (auto& smallest : smallest_) sort_in(pixels, smallest.data() + first, values_.data());
  }

  std::vector<float> values_;
  std::vector<int> neighbours_;
  std::array<std::vector<float>, most_nearest> smallest_;  ///< ascending
};

}  // namespace

RangeImage drop_outliers(const RangeImage& image, const PixelRays& rays, double max_deviations) {
  check_size(image, rays, "outlier filter");
  ImageF spacing = ImageF::Zero(image.rows(), image.cols());
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(spacing.size()));
  RowSpacing row_spacing(image.cols());
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    row_spacing.find(image, rays, row);
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (!image.valid(row, col)) continue;
      spacing(row, col) = row_spacing.mean(col);
      if (std::isfinite(spacing(row, col))) values.push_back(spacing(row, col));
    }
  }
  float most = 0;
  if (!values.empty()) {
    const float middle = median(values);
    for (float& value : values) value = std::abs(value - middle);
    const auto sigmas = static_cast<float>(sigma_of_median_deviation);
    const float deviation = std::max(least_deviation, sigmas * median(values));
    most = middle + static_cast<float>(max_deviations) * deviation;
  }
  RangeImage out = image;
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (image.valid(row, col) && spacing(row, col) > most) {
        out.invalidate(row, col, InvalidReason::outlier);
      }
    }
  }
  return out;
}

}  // namespace tofmap
