// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// Planes q = q0 + a (x − x0) + b (y − y0) of inverse depth q = 1/z over tangents x/z and y/z,
/// through the surfaces at the pixels (x0, y0) of a row.
struct PlaneRow {
  std::vector<int> neighbours;  ///< pixels that take part; 0: there is no plane
  std::vector<float> q0;
  std::vector<float> a;
  std::vector<float> b;
  std::vector<float> q0_variance;
  std::vector<float> a_variance;
  std::vector<float> b_variance;

  explicit PlaneRow(std::size_t cols)
      : neighbours(cols),
        q0(cols),
        a(cols),
        b(cols),
        q0_variance(cols),
        a_variance(cols),
        b_variance(cols) {}
};

/// Fits planes to the neighbours of pixels that lie on their own surface, a row at a time: the
/// window's pixels one after the other, for all pixels of the row together.
///
/// A first plane comes from lines along both axes, on the side that is straight where one crosses
/// an edge; neighbours near it are fitted, and again those near that fit, twice.
class PlaneFits {
 public:
  PlaneFits(const RangeImage& image, const PixelRays& rays, const CloudOptions& options);

  /// Planes with fewer than the options' neighbours, and those that their own pixel does not lie
  /// on, are none. Rows may be fitted by several threads.
  void fit(int row, PlaneRow& out) const;

  float tangent_x(int row, int col) const { return tangent_x_[place(row, col)]; }
  float tangent_y(int row, int col) const { return tangent_y_[place(row, col)]; }

 private:
  std::size_t place(int row, int col) const {
    return static_cast<std::size_t>((row + margin_) * stride_ + margin_ + col);
  }

  int rows_;
  int cols_;
  int margin_;  ///< around the planes, without values: half the window
  int stride_;
  float gate2_;
  int min_neighbours_;
  float least_spread2_ = 0;      ///< of tangents that do not lie on one line
  std::vector<float> q_;         ///< NaN where invalid
  std::vector<float> variance_;  ///< of q
  std::vector<float> tangent_x_;
  std::vector<float> tangent_y_;
};

}  // namespace tofmap
