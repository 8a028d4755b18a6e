// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

// The terms that the method `paper` computes as Droeschel, Holz and Behnke (IROS 2010) print them,
// and `jump` in another way. docs/unwrapping.md, "The paper to the letter", states how the paper
// was read where it leaves something open.

/// σ² of equations 1 and 3, cycles²: "the variance in the depth values between neighbouring pixels
/// in the wrapped image". It is the variance of φ(q) − φ(p) over all pixels p and their right and
/// lower neighbours q, both directions together. Phases are not unwrapped, so a phase jump counts
/// as a difference of nearly ±1. Pairs with a NaN are left out. The result is at least the square
/// of the step of 16-bit phases, also if there are no pairs.
double neighbour_variance_cycles2(const ImageF& phase);

/// Equation 2 as printed: wrap count 1 where |a mod λ_B − b| > τ, else 0, with the wrapped ranges a
/// and b of both frequencies and τ = `threshold_m`, metres. invalid_wrap_count where either phase
/// is NaN.
ImageU8 threshold_counts(const Frame& frame, const PairLimits& limits, double threshold_m);

/// τ of equation 2, metres: |λ_A − λ_B| / 2, halfway between the difference 0 of pixels with wrap
/// count 0 and the difference |λ_A − λ_B| of pixels with wrap count 1.
double halfway_threshold_m(const PairLimits& limits);

}  // namespace tofmap
