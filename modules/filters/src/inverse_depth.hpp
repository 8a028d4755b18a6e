// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// 1 / z of every pixel, 1 / m. Except for lens distortion, the inverse depth of a plane is linear
/// in the pixel coordinates, however slanted the plane is. Values are NaN where the pixel is
/// invalid, and in a margin around the image, so that neighbours need no check of the border.
class InverseDepth {
 public:
  /// Number of pixels that may be read beyond each border.
  static constexpr int margin = 2;

  /// An image in which all values are NaN.
  InverseDepth(Eigen::Index rows, Eigen::Index cols);

  /// The inverse depths of a range image. Throws UsageError if image and rays differ in size.
  InverseDepth(const RangeImage& image, const PixelRays& rays);

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int stride() const { return cols_ + 2 * margin; }  ///< from a pixel to the pixel below it

  // The first pixel of a row. The rest of the row follows it.
  const float* value(int row) const { return values_.data() + place(row); }
  const float* variance(int row) const { return variances_.data() + place(row); }
  const float* weight(int row) const { return weights_.data() + place(row); }
  float* value(int row) { return values_.data() + place(row); }
  float* variance(int row) { return variances_.data() + place(row); }
  float* weight(int row) { return weights_.data() + place(row); }

 private:
  std::size_t place(int row) const {
    return static_cast<std::size_t>(row + margin) * static_cast<std::size_t>(stride()) + margin;
  }

  int rows_;
  int cols_;
  std::vector<float> values_;
  std::vector<float> variances_;  ///< of the depth z, m²
  std::vector<float> weights_;    ///< in averages: confidence / variance of the depth
};

/// How pixels are averaged.
struct PairAverage {
  double max_sigmas;   ///< largest deviation of a pair from the pixel, standard deviations of both
  double tolerance_m;  ///< always accepted, in depth; added to max_sigmas in quadrature
};

/// Averages each pixel with the pairs of opposite pixels, one and two pixels away along rows,
/// columns and diagonals, whose means agree with it. On a plane the mean of each pair is the
/// pixel's own value, whatever the slant. The weight of a pair falls with its deviation (Tukey's
/// biweight). Both pairs of an axis are left out if they do not lie on one line, as across an edge.
/// Pixels that are NaN stay NaN. The weights of the result are NaN.
InverseDepth averaged_over_pairs(const InverseDepth& depth, const PairAverage& options);

}  // namespace tofmap
