// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/robust_cost.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

TOFMAP_VECTOR_CLONES void fill_weights(int count, const float* error_m, const float* variance_m2,
                                       float systematic_m2, float* weight) {
  constexpr float square_width = 9;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float variance = variance_m2[i] + systematic_m2;
    const float share = 1 / (1 + error_m[i] * error_m[i] / (square_width * variance));
    weight[i] = error_m[i] == error_m[i] ? share * share / variance : 0.0F;
  }
}

}  // namespace

double robust_cost(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                   double systematic_m) {
  const auto systematic_m2 = static_cast<float>(systematic_m * systematic_m);
  double sum = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < error_m.size(); ++i) {
    const float cost = robust_cost(error_m[i] * error_m[i] / (variance_m2[i] + systematic_m2));
    if (std::isnan(cost)) continue;
    sum += cost;
    ++seen;
  }
  if (seen == 0) return std::numeric_limits<double>::infinity();
  return sum / static_cast<double>(seen) * static_cast<double>(error_m.size());
}

void fill_robust_weights(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                         double systematic_m, std::vector<float>& weight) {
  fill_weights(static_cast<int>(weight.size()), error_m.data(), variance_m2.data(),
               static_cast<float>(systematic_m * systematic_m), weight.data());
}

}  // namespace tofmap
