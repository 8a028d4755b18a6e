// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Pixels in a row or column whose phases are combined with these weights.
struct Stencil {
  int size;
  std::array<float, 3> weights;
};
inline constexpr Stencil first_difference{2, {-1, 1, 0}};
inline constexpr Stencil second_difference{3, {1, -2, 1}};

/// The differences of one row of pixels with those `step_row`, `step_col` and twice as far away:
/// `cycles` in −1/2 … 1/2, and `relative_sigma`, their standard deviations for σ_phase = 1 /
/// amplitude; not finite where a phase or an amplitude is missing. `amplitude` may be empty, then
/// all are 1. Returns how many: as many as fit into the row.
int find_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                     Eigen::Index row, Eigen::Index step_row, Eigen::Index step_col, float* cycles,
                     float* relative_sigma);

}  // namespace tofmap
