// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// The range image of known ranges, their standard deviations, wrap counts and confidences, all of
/// the same size. Pixels with invalid_wrap_count become invalid, for no return.
RangeImage make_range_image(const ImageF& range_m, const ImageF& sigma_m, const ImageU8& counts,
                            const ImageF& confidence);

/// The range image of known wrap counts of one frequency, with the ranges (phase + n) λ. Pixels
/// with invalid_wrap_count become invalid, for no return.
RangeImage make_range_image(const ImageF& phase, const ImageF& sigma_cycles, const ImageU8& counts,
                            const ImageF& confidence, double wavelength_m);

}  // namespace tofmap
