// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frequency_difference.hpp"
#include "inverse_depth.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tofmap {

/// The pixels around one, counter-clockwise from the right; opposite ones are `axes` apart.
struct Neighbourhood {
  static constexpr int directions = 8;
  static constexpr int axes = directions / 2;
  static constexpr unsigned all = (1U << directions) - 1;  ///< a bit each
  static constexpr std::array<int, directions> rows{0, -1, -1, -1, 0, 1, 1, 1};
  static constexpr std::array<int, directions> cols{1, 1, 0, -1, -1, -1, 0, 1};

  /// How far a neighbour lies from the pixel in memory, if the pixel below is `stride` away.
  static constexpr int offset(std::size_t direction, int stride) {
    return rows[direction] * stride + cols[direction];
  }
};

/// What drop_off_planes() knows of an image.
struct Depths {
  InverseDepth own;
  InverseDepth smooth;  ///< averaged over pairs
  FrequencyDifference difference;
};

/// Limits of SurfaceAgreement: standard deviations, and metres that always agree.
struct AgreementLimits {
  double plane_sigmas;  ///< where no step is
  double edge_sigmas;   ///< at a step
  double tolerance_m;
  double mixing_m;  ///< two surfaces no farther apart than this mix to ranges between them
};

/// For each pixel, with which of the surfaces around it it agrees (docs/filters.md).
class SurfaceAgreement {
 public:
  SurfaceAgreement(const Depths& depths, const AgreementLimits& limits);

  /// Whether a surface passes from one side of the pixel to the other only by a step.
  bool is_at_step(int row, int col) const { return (sectors_[place(row, col)] & step_bit) != 0; }

  /// Whether three adjacent directions lead to one surface that the pixel is on.
  bool lies_on_surface(int row, int col) const {
    return (sectors_[place(row, col)] & surface_bit) != 0;
  }

  /// The same of the directions given, a bit each.
  bool lies_on_surface(int row, int col, unsigned among) const;

  /// The axes along which both directions predict the pixel closely, a bit each; none outside the
  /// image.
  unsigned lines(int row, int col) const;

 private:
  static constexpr int margin = 1;
  static constexpr unsigned step_bit = 1U << Neighbourhood::directions;
  static constexpr unsigned surface_bit = step_bit << 1;

  std::size_t place(int row, int col) const {
    return static_cast<std::size_t>((row + margin) * stride_ + margin + col);
  }

  int stride_;
  std::vector<unsigned> agrees_;  ///< by direction: within the widest, the middle, the least limit
  std::vector<unsigned>
      sectors_;  ///< by the middle direction of three; and whether there is a step
};

}  // namespace tofmap
