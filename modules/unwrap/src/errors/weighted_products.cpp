// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/weighted_products.hpp"

#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {

TOFMAP_VECTOR_CLONES static float dot_in_lanes(int count, const float* a, const float* b) {
  constexpr int lanes = DiagonalLayout::lanes;
  std::array<float, lanes> sums{};
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
#pragma GCC ivdep
    for (int k = 0; k < lanes; ++k) sums[static_cast<std::size_t>(k)] += a[i + k] * b[i + k];
  }
  float sum = 0;
  for (const float lane : sums) sum += lane;
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

float dot(std::size_t count, const float* a, const float* b) {
  return dot_in_lanes(static_cast<int>(count), a, b);
}

}  // namespace tofmap
