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
  /// Only pixels whose range noise exceeds this fraction of λ_A are averaged, 0 … 1.
  double min_noise_cycles = 0.1;
  /// Largest radius of the windows, pixels. Nothing is averaged if it is below 2.
  double max_radius_px = 16;
};

/// Averages the phasors of pixels that are so noisy that neither their wrap counts nor edges can be
/// seen. The windows grow with the noise, along surfaces but not across edges (docs/filters.md,
/// section phasor_mean).
///
/// A plane is fitted to the phasors of all frequencies, which are taken to be equally noisy, in the
/// window of each noisy pixel. The pixel gets the range of that plane, with the wrap count that is
/// most probable given the phases of the plane and the pixel's previous wrap count and confidence:
/// - wrap_count is the number of whole λ_A in the range,
/// - confidence is the probability of the count,
/// - sigma_m is the standard deviation of the range if the count is right,
/// - averaged_px is the number of pixels over whose noise the range is averaged.
///
/// Pixels with less noise contribute their phasors, but are not changed. The image is returned
/// unchanged if fewer than half of its valid pixels are noisy. No pixel becomes valid or invalid.
/// With one frequency, the image is returned unchanged.
/// Throws UsageError if image, frame and rays differ in size, or frame and modulation in
/// frequencies; the frame is checked only if there are enough noisy pixels.
RangeImage average_phasors(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PhasorMeanLimits& limits);

}  // namespace tofmap
