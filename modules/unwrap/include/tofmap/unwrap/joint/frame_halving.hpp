// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// A frame and the noise of its phases; both NaN where there is no return.
struct NoisyFrame {
  Frame frame;
  PhaseSigma sigma;
};

/// Halves a frame in width and height, rounded up: averages the phasors of blocks of 2 x 2 pixels
/// and propagates their noise. Pixels without a return at either frequency are left out; a block
/// without any return has NaN phases and amplitude 0. If the frame has no amplitudes, all its
/// phasors have length 1; the result has amplitudes in any case, the lengths of the mean phasors.
NoisyFrame halve(const Frame& frame, const PhaseSigma& sigma);

}  // namespace tofmap
