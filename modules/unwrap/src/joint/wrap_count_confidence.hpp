// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// The confidence of `joint`, 0 … 1: beliefs, calibrated to the probability that the wrap count is
/// right (docs/unwrapping.md, equation 22). At the same noise, it rises with the log odds of the
/// belief. 0 where the wrap count is invalid; `sigma_a_cycles` is not used there.
///
/// `sigma_a_cycles` is the noise of the first frequency's phase. The calibration depends on the
/// noise of the residuals relative to their changes by another wrap count (residual_noise_steps).
/// That noise is computed as if all frequencies had the noise of the first one, since the others
/// may come from another exposure.
///
/// With three or more frequencies, confidence falls with the number of neighbours to which the
/// range jumps, in `range_m`, which is NaN where there is none: the light of such pixels is often
/// that of two surfaces. With two, `range_m` is not used.
ImageF wrap_count_confidence(const WrapCountBeliefs& beliefs, const ImageF& range_m,
                             const ImageF& sigma_a_cycles, const UnwrapLimits& limits);

}  // namespace tofmap
