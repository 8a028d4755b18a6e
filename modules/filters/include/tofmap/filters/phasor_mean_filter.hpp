// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of average_phasors().
struct PhasorMeanLimits {
  double min_noise_cycles =
      0.1;                    ///< pixels with less noise than that share of λ_A stay as they are
  double max_radius_px = 16;  ///< windows grow no farther; 0: nothing is averaged
};

/// Ranges of pixels whose phases are so noisy that neither their wraps nor edges show in them: from
/// phasors of both frequencies, averaged in windows that grow with the noise, along surfaces and
/// not across edges (docs/filters.md).
///
/// The range of such a pixel becomes that of the plane fitted to the phasors of its window, at the
/// count that both frequencies and the pixel's own count and confidence make the likeliest;
/// wrap_count is the whole wavelengths in that range, confidence the probability of that count,
/// sigma_m the standard deviation within it, and averaged_px tells how many pixels' noise is in it.
/// Other pixels lend their phasors and stay as they are. An image in which less than half
/// of the pixels are that noisy stays as a whole. No pixel becomes valid or invalid. Throws
/// UsageError if image, frame and rays differ in size.
RangeImage average_phasors(const RangeImage& image, const DualFrequencyFrame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PhasorMeanLimits& limits);

}  // namespace tofmap
