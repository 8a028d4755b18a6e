// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace tofmap {

// The robust cost of Geman and McClure for a residual error, with a kernel that is three standard
// deviations wide (docs/unwrapping.md, equation 20):
//
//   c(x) = ½ x² / (1 + x² / 9),   x² = error² / (variance + systematic²)
//
// It is about ½ x² for samples that fit, and at most 4.5 nats for outliers.

/// c(x), in nats, given `square` = x². NaN if x² is NaN.
[[gnu::always_inline]] inline float robust_cost(float square) {
  constexpr float square_width = 9;
  return square / 2 / (1 + square / square_width);
}

/// The sum of the costs of all samples, in nats. A sample whose error is NaN was not seen at B; its
/// cost is the mean cost of the samples that were seen. Infinite if no sample was seen. The
/// arguments are errors in metres, their variances, and the systematic error's standard deviation.
double robust_cost(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                   double systematic_m);

/// Fills in the weight of each sample in iteratively reweighted least squares: c'(x) / x divided by
/// the variance, which includes the systematic error. 0 where the error is NaN. `weight` must have
/// the size of `error_m`.
void fill_robust_weights(const std::vector<float>& error_m, const std::vector<float>& variance_m2,
                         double systematic_m, std::vector<float>& weight);

}  // namespace tofmap
