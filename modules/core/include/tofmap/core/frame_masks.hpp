// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// True where one of the frequencies has no return.
Image<bool> missing_returns(const Frame& frame);

/// True where the amplitude of one of the frequencies is at least `saturation_amplitude`. False
/// everywhere without amplitudes.
Image<bool> saturated_pixels(const Frame& frame, double saturation_amplitude);

}  // namespace tofmap
