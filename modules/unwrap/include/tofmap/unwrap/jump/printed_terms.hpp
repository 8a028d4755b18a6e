// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// What the method `paper` computes as Droeschel, Holz and Behnke (IROS 2010) print it, and `jump`
/// otherwise. docs/unwrapping.md, "The paper to the letter", says how each was read.

/// σ² of equations 1 and 3, "the variance in the depth values between neighbouring pixels in the
/// wrapped image", cycles²: the variance of φ(q) − φ(p) over all pixels p and their right and lower
/// neighbours q, both directions together. Differences are those of the wrapped image, so a phase
/// jump counts as the step of nearly ±1 that the image shows.
/// Pairs with a NaN take no part. At least the square of the step of 16-bit phases, so that an
/// image without any contrast has a σ as well; without a pair it is that, too.
double neighbour_variance_cycles2(const ImageF& phase);

/// Equation 2: count 1 where |a mod λ_B − b| > τ, else 0; a and b are the wrapped ranges of both
/// frequencies, metres. invalid_wrap_count where either phase is NaN.
ImageU8 threshold_counts(const DualFrequencyFrame& frame, const UnwrapLimits& limits,
                         double threshold_m);

/// τ of equation 2, metres: |λ_A − λ_B| / 2, halfway between the differences that equation 2
/// expects of pixels that are not wrapped, and of those that are.
double halfway_threshold_m(const UnwrapLimits& limits);

}  // namespace tofmap
