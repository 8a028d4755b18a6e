// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>

namespace tofmap {

/// m of the error model (tofmap/core/range_error.hpp): by which factor the noise of each pixel
/// differs from what `noise` and its amplitude say, as ambient light makes it; both frequencies
/// have the same. Empty if no part of the image differs by more than edges and chance explain.
///
/// Found in blocks of 16 x 16 pixels: of their second differences, normalised by the noise
/// expected, the shares below 0.67 and below 2.5 tell the factor apart from a share of differences
/// across edges, which are large for another reason. Between the centres of blocks its logarithm is
/// interpolated.
ImageF find_ambient_noise(const DualFrequencyFrame& frame, const PhaseNoise& noise);

}  // namespace tofmap
