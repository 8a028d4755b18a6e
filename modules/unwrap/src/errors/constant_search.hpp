// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// Samples and their predicted residuals, without the constant that is searched for. All vectors
/// have one element per sample.
struct PredictedSamples {
  std::vector<float> phase_a;      ///< cycles
  std::vector<float> phase_b;      ///< cycles; not NaN
  std::vector<float> amplitude_a;  ///< empty if the frame has no amplitudes
  std::vector<float> predicted_m;  ///< predicted residual
  std::vector<float> variance_m2;  ///< variance of the residual's noise
};

/// Prior knowledge about the constant and the residuals.
struct ConstantPrior {
  double constant_m;          ///< standard deviation of the constant
  double systematic_m;        ///< standard deviation of the residuals besides noise
  double correlated_samples;  ///< number of samples that count as one independent sample
};

/// The largest absolute value of a constant that is searched, metres: half of the residual step,
/// and at least 12 cm.
double largest_constant_m(const PairLimits& limits);

/// The most likely constant that is added to the residuals of all samples, metres. It minimises
/// equation 24 of docs/unwrapping.md over constants a centimetre apart, up to largest_constant_m()
/// in both directions. 0 if there are no samples.
double likeliest_constant_m(const PairLimits& limits, const ConstantPrior& prior,
                            const PredictedSamples& samples);

}  // namespace tofmap
