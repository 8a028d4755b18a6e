// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Limits of mend_isolated_wraps().
struct IsolatedWrapLimits {
  double max_share = 0.01;  ///< regions of a larger share of the image are none
};

/// Corrects or drops small regions whose wrap count is wrong.
///
/// A region is what hangs together without a step of half a wavelength. One that is small, and
/// whose border is mostly a whole number of wavelengths off the same surroundings, is judged by the
/// residual of its pixels (range by A against range by B). Unless this is surely better by the
/// region's own counts than by those of the surroundings, the region gets these, with A's ranges
/// (B's may have been fused into them by the wrong count) and the confidence of the surroundings.
/// If the residual is surely better by a third count, the region is dropped. Else it is an object,
/// and stays.
///
/// An image without any wraps was not unwrapped, and stays as it is. Throws UsageError if image and
/// frame differ in size.
RangeImage mend_isolated_wraps(const RangeImage& image, const DualFrequencyFrame& frame,
                               const Modulation& modulation, const IsolatedWrapLimits& limits);

}  // namespace tofmap
