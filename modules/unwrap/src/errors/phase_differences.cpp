// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/phase_differences.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Consecutive pixels of one image row.
using Row = const float*;

/// The variance of a phase for a noise scale of 1: 1 / amplitude². Infinite without light.
[[gnu::always_inline]] inline float relative_variance(float amplitude) {
  const float light = amplitude > 0 ? amplitude : 0.0F;
  return 1 / (light * light);
}

TOFMAP_VECTOR_CLONES void fill_differences(int count, const std::array<Row, 3>& phase,
                                           const std::array<Row, 3>& amplitude,
                                           const std::array<float, 3>& weights, float* cycles,
                                           float* relative_sigma) {
  const auto [phase_0, phase_1, phase_2] = phase;
  const auto [amplitude_0, amplitude_1, amplitude_2] = amplitude;
  const auto [weight_0, weight_1, weight_2] = weights;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float difference = weight_0 * phase_0[i] + weight_1 * phase_1[i] + weight_2 * phase_2[i];
    const float variance = weight_0 * weight_0 * relative_variance(amplitude_0[i]) +
                           weight_1 * weight_1 * relative_variance(amplitude_1[i]) +
                           weight_2 * weight_2 * relative_variance(amplitude_2[i]);
    const bool is_present = difference == difference;
    cycles[i] = to_half_cycle(is_present ? difference : 0.0F);
    // Adding 0 * difference passes a NaN on without a branch.
    relative_sigma[i] = std::sqrt(variance) + 0 * difference;
  }
}

}  // namespace

int find_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                     Eigen::Index row, Eigen::Index step_row, Eigen::Index step_col, float* cycles,
                     float* relative_sigma) {
  const Eigen::Index reach = stencil.size - 1;
  const Eigen::Index count = phase.cols() - reach * step_col;
  if (count <= 0 || row + reach * step_row >= phase.rows()) return 0;
  const std::vector<float> ones(amplitude.size() > 0 ? 0 : static_cast<std::size_t>(count), 1.0F);
  std::array<Row, 3> phases{};
  std::array<Row, 3> amplitudes{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    // The third weight of a stencil of two pixels is 0, so its pixel does not matter.
    const Eigen::Index k = std::min(i, reach);
    const Eigen::Index place = (row + k * step_row) * phase.cols() + k * step_col;
    phases[static_cast<std::size_t>(i)] = phase.data() + place;
    amplitudes[static_cast<std::size_t>(i)] =
        amplitude.size() > 0 ? amplitude.data() + place : ones.data();
  }
  fill_differences(static_cast<int>(count), phases, amplitudes, stencil.weights, cycles,
                   relative_sigma);
  return static_cast<int>(count);
}

}  // namespace tofmap
