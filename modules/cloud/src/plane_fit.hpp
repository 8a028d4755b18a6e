// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// One plane for each pixel of a row: q = q0 + a (x − x0) + b (y − y0), where q is inverse depth,
/// x and y are the tangents of a ray (X/Z and Y/Z), and x0 and y0 are those of the pixel.
struct PlaneRow {
  std::vector<int> neighbours;  ///< number of pixels in the fit; 0 if the pixel has no plane
  std::vector<float> q0;
  std::vector<float> a;
  std::vector<float> b;
  std::vector<float> q0_variance;
  std::vector<float> a_variance;
  std::vector<float> b_variance;
  std::vector<float> excess;  ///< how much more the neighbours scatter than predicted, at least 1

  explicit PlaneRow(std::size_t cols)
      : neighbours(cols),
        q0(cols),
        a(cols),
        b(cols),
        q0_variance(cols),
        a_variance(cols),
        b_variance(cols),
        excess(cols) {}
};

/// Fits a plane to those neighbours of each pixel that lie on the same surface. A row is processed
/// at a time: the outer loop is over the pixels of the window, the inner one over the row.
///
/// An initial plane comes from lines through the pixel along both axes; where a line crosses an
/// edge, only its straighter side is used. Then a plane is fitted to the neighbours near the
/// previous plane, three times.
class PlaneFits {
 public:
  PlaneFits(const RangeImage& image, const PixelRays& rays, const CloudOptions& options);

  /// Fits the planes of a row. A pixel has no plane if any of its fits has fewer than
  /// `min_neighbours` pixels, or if the pixel does not lie on its own plane. May be called by
  /// several threads.
  void fit(int row, PlaneRow& out) const;

  /// Fits those planes of a row anew, at some columns, that mix surfaces which meet in a fold, as a
  /// wall and the floor do. There, the pixels next to the one that the plane is for are all in
  /// front of it, or all behind it. `averaged` are the averaged_px of the image's row, or null if
  /// nothing was averaged.
  ///
  /// The plane is then fitted to one side of the window alone: to that half or quarter around the
  /// pixel which lies on a plane best. If none lies on one, the plane stays, and its distance from
  /// the pixels next to the pixel adds to its variance.
  void refit_folds(int row, std::span<const int> columns, const float* averaged,
                   PlaneRow& out) const;

  float tangent_x(int row, int col) const { return tangent_x_[place(row, col)]; }
  float tangent_y(int row, int col) const { return tangent_y_[place(row, col)]; }

 private:
  class OneSidedFits;

  std::size_t place(int row, int col) const {
    return static_cast<std::size_t>((row + margin_) * stride_ + margin_ + col);
  }

  int rows_;
  int cols_;
  int margin_;  ///< width of the border of pixels without values: half the window
  int stride_;
  float gate2_;
  int min_neighbours_;
  float least_spread2_ = 0;      ///< smallest mean square of tangents that are not all on one line
  std::vector<float> q_;         ///< NaN where invalid
  std::vector<float> variance_;  ///< of q
  std::vector<float> tangent_x_;
  std::vector<float> tangent_y_;
};

}  // namespace tofmap
