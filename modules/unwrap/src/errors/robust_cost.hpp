// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tofmap {

// Geman and McClure's cost of a residual error, with a kernel three standard deviations wide:
//
//   c(x) = ½ x² / (1 + x² / 9),   x² = error² / (variance + systematic²)
//
// It is ½ x² for samples that fit, and 4.5 nats at most for those that do not
// (docs/unwrapping.md, equation 20).

/// c of a squared x, nats; NaN stays NaN.
[[gnu::always_inline]] inline float robust_cost(float square) {
  constexpr float square_width = 9;
  return square / 2 / (1 + square / square_width);
}

/// The sum of the costs of samples, nats. An error of NaN says that the sample was not seen: it
/// costs the mean of those that were. Infinite if none was.
double robust_cost(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                   double systematic_m);

/// The weight of each sample in the least squares that minimise the cost: c'(x) / x over the
/// variance; 0 where the error is NaN.
void fill_robust_weights(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                         double systematic_m, std::vector<float>& weight);

}  // namespace tofmap
