// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/residual_samples.hpp"

#include <vector>

namespace tofmap {

/// The design matrix of the model of CameraErrors (docs/unwrapping.md, equation 18): one column per
/// coefficient, in the order of CameraErrors::coefficient_m, with the factor of that coefficient at
/// each sample. `phase_b` is B's phase at each sample, in cycles; where it is NaN, all factors but
/// that of the offset are 0. Without amplitudes, the last column is 0.
std::vector<std::vector<float>> camera_error_terms(const SurfaceSamples& samples,
                                                   const std::vector<float>& phase_b,
                                                   double reference_amplitude);

}  // namespace tofmap
