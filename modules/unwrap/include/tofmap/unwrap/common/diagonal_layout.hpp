// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tofmap {

/// Where the values of an image's pixels lie when they are stored diagonal by diagonal: the pixel
/// in column u and row v belongs to diagonal u + v, whose pixels follow one another by row.
///
/// A sweep over an image that needs the results of the left and the upper neighbour can treat a
/// whole diagonal at once, and all its operands are contiguous in memory: the right neighbour of
/// row v is row v of the next diagonal, the lower one its row v + 1. Every diagonal has `planes`
/// values a pixel, plane by plane, and room for one row more at both ends; so have the diagonals
/// −1 and diagonals(), so that what is sent out of the image lands nowhere. After that there is
/// room to the end of a vector: loops over rows may go on to whole_vectors() of them, as long as
/// nobody needs what they leave there.
class DiagonalLayout {
 public:
  /// Floats in the longest vector of a processor.
  static constexpr int lanes = 16;

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
  int diagonals() const { return rows_ + cols_ - 1; }

  /// The rows begin(d) … end(d) − 1 of diagonal d have a pixel.
  int begin(int diagonal) const { return std::max(0, diagonal - cols_ + 1); }
  int end(int diagonal) const { return std::min(rows_ - 1, diagonal) + 1; }

  /// Values to allocate for this many planes.
  std::size_t size(std::size_t planes) const { return start_.back() * planes; }

  /// From one plane of a diagonal to its next.
  std::size_t plane_step(int diagonal) const {
    return start_[static_cast<std::size_t>(diagonal) + 2] -
           start_[static_cast<std::size_t>(diagonal) + 1];
  }

  /// The place of a row, from begin(d) − 1 on, in the first plane of a diagonal.
  std::size_t place(int diagonal, int row, std::size_t planes) const {
    return start_[static_cast<std::size_t>(diagonal) + 1] * planes +
           static_cast<std::size_t>(row - begin(diagonal) + 1);
  }

 private:
  int rows_ = 0;
  int cols_ = 0;
  std::vector<std::size_t> start_;  ///< of diagonal d at d + 1, for one plane
};

}  // namespace tofmap
