// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace tofmap {

/// A single-channel image, stored row by row. `image(v, u)` is the pixel in row v and column u;
/// (0, 0) is the top left pixel.
template <class Scalar>
using Image = Eigen::Array<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using ImageF = Image<float>;
using ImageU8 = Image<std::uint8_t>;
using ImageU16 = Image<std::uint16_t>;

/// The value of a pixel, or of a score, that is unknown.
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// True if both images have the same width and height.
template <class A, class B>
bool same_size(const Eigen::DenseBase<A>& a, const Eigen::DenseBase<B>& b) {
  return a.rows() == b.rows() && a.cols() == b.cols();
}

/// True if both images have the same size and values. NaN equals NaN.
inline bool same_values(const ImageF& a, const ImageF& b) {
  return same_size(a, b) && ((a == b) || (a.isNaN() && b.isNaN())).all();
}

}  // namespace tofmap
