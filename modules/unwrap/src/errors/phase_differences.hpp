// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// A difference of phases: `size` neighbouring pixels of a row or column are combined with these
/// weights.
struct Stencil {
  int size;
  std::array<float, 3> weights;
};
inline constexpr Stencil first_difference{2, {-1, 1, 0}};
inline constexpr Stencil second_difference{3, {1, -2, 1}};

/// Applies a stencil to the pixels of `row` and their neighbours in steps of `step_row` and
/// `step_col`. Writes the differences, wrapped to −1/2 … 1/2, to `cycles`, and their standard
/// deviations for σ_phase = 1 / amplitude to `relative_sigma`, which is not finite where a phase or
/// an amplitude is missing. If `amplitude` is empty, all amplitudes are 1. Returns the number of
/// differences: as many as fit into the row, 0 if the stencil leaves the image.
int find_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                     Eigen::Index row, Eigen::Index step_row, Eigen::Index step_col, float* cycles,
                     float* relative_sigma);

}  // namespace tofmap
