// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// True where one of the frequencies has no return.
Image<bool> missing_returns(const Frame& frame);

/// True where the amplitude of one of the frequencies is at least `saturation_amplitude`
/// (SensorModel). False everywhere without amplitudes, or if it is 0.
Image<bool> saturated_pixels(const Frame& frame, double saturation_amplitude);

}  // namespace tofmap
