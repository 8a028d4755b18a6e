// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// Samples, and what is predicted of their residuals but for the constant; one number of each kind
/// a sample.
struct PredictedSamples {
  std::vector<float> phase_a;
  std::vector<float> phase_b;
  std::vector<float> amplitude_a;  ///< empty if there is none
  std::vector<float> predicted_m;
  std::vector<float> variance_m2;  ///< noise of the residual
};

/// What is expected before the samples are looked at.
struct ConstantPrior {
  double constant_m;          ///< standard deviation of the constant
  double systematic_m;        ///< standard deviation of the residuals besides noise
  double correlated_samples;  ///< so many samples count as one that is independent
};

/// Constants up to this, either way, are thought possible, metres: half of the residual step, and
/// 12 cm at least.
double largest_constant_m(const UnwrapLimits& limits);

/// The most likely constant by which the residuals of all samples are off alike, metres: the least
/// of docs/unwrapping.md, equation 24, among constants a centimetre apart, up to the largest. 0 if
/// there are no samples.
double likeliest_constant_m(const UnwrapLimits& limits, const ConstantPrior& prior,
                            const PredictedSamples& samples);

}  // namespace tofmap
