// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// 1 / z of every pixel, 1 / m: a plane is linear in it over the pixels, however slanted (but for
/// lens distortion). NaN where the pixel is invalid, and in a margin around the image, so that
/// neighbours need no care.
class InverseDepth {
 public:
  /// Pixels that may be asked for beyond each border.
  static constexpr int margin = 2;

  /// An image without values.
  InverseDepth(Eigen::Index rows, Eigen::Index cols);

  /// Throws UsageError if image and rays differ in size.
  InverseDepth(const RangeImage& image, const PixelRays& rays);

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int stride() const { return cols_ + 2 * margin; }  ///< from a pixel to the one below it

  /// The first pixel of a row.
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
  std::vector<float> weights_;    ///< in means: confidence over that variance
};

/// How pixels are averaged.
struct PairAverage {
  double max_sigmas;  ///< pairs farther off the pixel than that, in the noise of both, are left out
  double tolerance_m;  ///< but not if they are no farther off than that in depth
};

/// Averages each pixel with pairs of opposite pixels, one and two pixels away along rows, columns
/// and diagonals, whose means agree with it: on a plane the mean of each pair is the pixel's own
/// value, whatever the slant. Pairs weigh the less the farther off they are (Tukey's biweight), and
/// both of an axis are left out where they do not lie on one line, as across an edge. Pixels that
/// have no value get none. Averages have no weights.
InverseDepth averaged_over_pairs(const InverseDepth& depth, const PairAverage& options);

}  // namespace tofmap
