// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// Estimates the noise from one frame: the median absolute second difference of the wrapped
/// phase along rows and columns, each divided by what amplitudes predict for it.
///
/// A second difference cancels planes to first order and needs no unwrapping; the median
/// passes over edges. (The residual between A and B, the obvious other source, is bounded by
/// half a residual step and so saturates just when the noise is large.)
/// The result is at least the quantisation of 16-bit phases; where too few pixels have
/// neighbours to tell (fewer than 16 triples), it is a noise of 0.01 cycles at the median
/// amplitude.
PhaseNoise estimate_phase_noise(const DualFrequencyFrame& frame);

}  // namespace tofmap
