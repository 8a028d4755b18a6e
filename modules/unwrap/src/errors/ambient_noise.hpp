// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// Estimates m of the error model (tofmap/core/range_error.hpp): the factor by which the noise of
/// each pixel differs from what `noise` and the pixel's amplitude predict. Ambient light causes
/// such differences; m is the same at all frequencies. Returns an image of the frame's size, or an
/// empty image if m is 1 everywhere, up to what edges and chance explain.
///
/// m is estimated in blocks of 16 x 16 pixels, from second differences of the phases divided by
/// their predicted noise. The shares of differences below 0.67 and below 2.5 separate the factor
/// from differences across edges, which are large for another reason. Between the centres of
/// blocks, the logarithm of m is interpolated. m is 1 where the predicted noise is so large that
/// differences wrap (above 0.16 cycles).
ImageF find_ambient_noise(const Frame& frame, const std::vector<PhaseNoise>& noise);

}  // namespace tofmap
