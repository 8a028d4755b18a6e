// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// The image of counts that are known, with ranges, their standard deviations, and confidences.
RangeImage make_range_image(const ImageF& range_m, const ImageF& sigma_m, const ImageU8& counts,
                            const ImageF& confidence);

/// The same with A's ranges: (phase_a + n) λ_A.
RangeImage make_range_image(const ImageF& phase_a, const ImageF& sigma_a_cycles,
                            const ImageU8& counts, const ImageF& confidence,
                            const UnwrapLimits& limits);

}  // namespace tofmap
