// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// Estimates the phase noise of one frame at each frequency (docs/unwrapping.md, 'Noise').
///
/// The scale of the noise is the median absolute second difference of the wrapped phase along rows
/// and columns, each difference divided by the relative noise that the amplitudes predict for it.
/// Second differences cancel planes to first order and need no unwrapping; the median is robust to
/// edges. If the noise is so large that most differences wrap, only the quieter half of them is
/// used, and if that half is too noisy as well, the mean cosine of first differences. (The
/// inter-frequency residual cannot replace them: it is bounded, so it saturates when the noise is
/// large.)
///
/// The estimate is at least the quantisation step of the phases, and that is at least the step of
/// 16-bit phases. With fewer than 16 second differences, the estimate is a noise of 0.01 cycles at
/// the median amplitude.
std::vector<PhaseNoise> estimate_phase_noise(const Frame& frame);

}  // namespace tofmap
