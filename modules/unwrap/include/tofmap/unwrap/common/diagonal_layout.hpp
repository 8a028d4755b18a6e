// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tofmap {

/// Memory layout of an image that is stored diagonal by diagonal. The pixel in column u and row v
/// belongs to diagonal u + v; the pixels of a diagonal are ordered by row.
///
/// A sweep that needs the results of the left and the upper neighbour can process a whole diagonal
/// at once, with all operands contiguous in memory: the right neighbour of row v is row v of the
/// next diagonal, and the lower neighbour is row v + 1 of the next diagonal.
///
/// Each diagonal stores `planes` values per pixel, plane by plane, with padding of one row at both
/// ends. The diagonals −1 and diagonals() exist as padding, too, so that values which are sent
/// across the border of the image overwrite no pixel. Each diagonal also ends with padding to whole
/// SIMD vectors: a loop may process whole_vectors(rows) rows, and what it writes beyond the last
/// row is never read as a result.
class DiagonalLayout {
 public:
  /// Floats in the longest SIMD vector that is supported (AVX-512).
  static constexpr int lanes = 16;

  /// `rows`, rounded up to a multiple of `lanes`.
  static int whole_vectors(int rows) { return (rows + lanes - 1) / lanes * lanes; }

  DiagonalLayout() = default;

  DiagonalLayout(int rows, int cols) : rows_(rows), cols_(cols) {
    std::size_t place = 0;
    for (int d = -1; d <= diagonals(); ++d) {
      start_.push_back(place);
      const int room = whole_vectors(std::max(end(d) - begin(d), 1)) + 2;
      place += static_cast<std::size_t>(whole_vectors(room));
    }
    start_.push_back(place);
  }

  int rows() const { return rows_; }
  int cols() const { return cols_; }

  /// The number of diagonals that hold pixels.
  int diagonals() const { return rows_ + cols_ - 1; }

  /// Diagonal d holds the pixels of rows begin(d) … end(d) − 1.
  int begin(int diagonal) const { return std::max(0, diagonal - cols_ + 1); }
  int end(int diagonal) const { return std::min(rows_ - 1, diagonal) + 1; }

  /// The number of values to allocate for so many planes of all diagonals.
  std::size_t size(std::size_t planes) const { return start_.back() * planes; }

  /// The number of values from one plane of a diagonal to its next plane.
  std::size_t plane_step(int diagonal) const {
    return start_[static_cast<std::size_t>(diagonal) + 2] -
           start_[static_cast<std::size_t>(diagonal) + 1];
  }

  /// Index of a row's value in the first plane of a diagonal. The first row allowed is
  /// begin(diagonal) − 1, which is padding. `planes` must be the same as in size().
  std::size_t place(int diagonal, int row, std::size_t planes) const {
    return start_[static_cast<std::size_t>(diagonal) + 1] * planes +
           static_cast<std::size_t>(row - begin(diagonal) + 1);
  }

 private:
  int rows_ = 0;
  int cols_ = 0;
  std::vector<std::size_t> start_;  ///< [d + 1]: index at which diagonal d begins, for one plane
};

}  // namespace tofmap
