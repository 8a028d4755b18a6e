// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frequency_difference.hpp"
#include "inverse_depth.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tofmap {

/// The 8 directions to the neighbours of a pixel, counter-clockwise from the right. Opposite
/// directions are `axes` apart.
struct Neighbourhood {
  static constexpr int directions = 8;
  static constexpr int axes = directions / 2;
  static constexpr unsigned all = (1U << directions) - 1;  ///< one bit per direction
  static constexpr std::array<int, directions> rows{0, -1, -1, -1, 0, 1, 1, 1};
  static constexpr std::array<int, directions> cols{1, 1, 0, -1, -1, -1, 0, 1};

  /// Offset in memory from a pixel to its neighbour; `stride` is the offset to the pixel below.
  static constexpr int offset(std::size_t direction, int stride) {
    return rows[direction] * stride + cols[direction];
  }
};

/// The depths of an image, as drop_off_planes() uses them.
struct Depths {
  InverseDepth own;     ///< not averaged
  InverseDepth smooth;  ///< averaged over pairs
  FrequencyDifference difference;
};

/// Limits of SurfaceAgreement.
struct AgreementLimits {
  double plane_sigmas;  ///< standard deviations, for pixels that are not at a step
  double edge_sigmas;   ///< standard deviations, for pixels at a step
  double tolerance_m;   ///< always accepted, in depth; added to the others in quadrature
  double mixing_m;      ///< mixed pixels of surfaces closer than this lie between the surfaces
};

/// Tells for each pixel which of the surfaces around it agree with it (docs/filters.md, section
/// plane_edge).
class SurfaceAgreement {
 public:
  SurfaceAgreement(const Depths& depths, const AgreementLimits& limits);

  /// Whether two opposite sides of the pixel are different surfaces.
  bool is_at_step(int row, int col) const { return (sectors_[place(row, col)] & step_bit) != 0; }

  /// Whether three adjacent directions agree with the pixel, so that it lies on their surface.
  bool lies_on_surface(int row, int col) const {
    return (sectors_[place(row, col)] & surface_bit) != 0;
  }

  /// Whether three adjacent directions of `among`, one bit per direction, agree with the pixel.
  bool lies_on_surface(int row, int col, unsigned among) const;

  /// One bit per axis along which both directions agree with the pixel within edge_sigmas. 0 for
  /// pixels up to one beyond the border of the image.
  unsigned lines(int row, int col) const;

 private:
  static constexpr int margin = 1;
  static constexpr unsigned step_bit = 1U << Neighbourhood::directions;
  static constexpr unsigned surface_bit = step_bit << 1;

  std::size_t place(int row, int col) const {
    return static_cast<std::size_t>((row + margin) * stride_ + margin + col);
  }

  int stride_;
  /// For each pixel and direction, whether they agree within the limits for planes (lowest 8 bits),
  /// for a single direction at a step (next 8), and for edges (next 8).
  std::vector<unsigned> agrees_;
  /// For each pixel, one bit per direction that is in the middle of three whose mean agrees with
  /// the pixel; then step_bit and surface_bit.
  std::vector<unsigned> sectors_;
};

}  // namespace tofmap
