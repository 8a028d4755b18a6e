// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/residual_samples.hpp"

#include <vector>

namespace tofmap {

/// The factors of the coefficients of CameraErrors (docs/unwrapping.md, equation 18) at each
/// sample: CameraErrors::coefficients columns of as many numbers as there are samples. Where
/// `phase_b` is NaN, all but the first factor are 0.
std::vector<std::vector<float>> camera_error_terms(const SurfaceSamples& samples,
                                                   const std::vector<float>& phase_b,
                                                   double reference_amplitude);

}  // namespace tofmap
