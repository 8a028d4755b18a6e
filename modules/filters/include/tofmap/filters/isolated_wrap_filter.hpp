// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of mend_isolated_wraps().
struct IsolatedWrapLimits {
  /// Leaves regions alone that are larger than this fraction of the image, 0 … 1.
  double max_share = 0.01;
};

/// Corrects or drops small regions whose wrap count is wrong.
///
/// A region is a 4-connected set of valid pixels without a step of λ_A / 2 between neighbours. The
/// filter tests each small region whose range differs from that of its surroundings by the same
/// whole number of λ_A along more than half of its border. The sum of the squared inter-frequency
/// residuals of its pixels decides among three cases (docs/filters.md, equation 1):
/// - One of the other wrap counts within two of the region's own fits clearly better than both the
///   region's own and those of the surroundings: the region is dropped, with the reason
///   `isolated_wrap`.
/// - The region's own wrap counts fit clearly better than those of the surroundings: the region is
///   an object, and stays.
/// - Otherwise the region gets the wrap counts of the surroundings. Its ranges are then those of
///   phase A alone, since phase B may have been fused into them with the wrong count, sigma_m grows
///   by √2, and its confidence is the mean confidence of the surroundings.
///
/// An image in which all wrap counts are 0 was not unwrapped, and is returned unchanged. Throws
/// UsageError if image and frame differ in size.
RangeImage mend_isolated_wraps(const RangeImage& image, const Frame& frame,
                               const Modulation& modulation, const IsolatedWrapLimits& limits);

}  // namespace tofmap
