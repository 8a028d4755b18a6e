// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops pixels whose amplitude, the weaker of both frequencies, is below `min_amplitude` (in the
/// camera's own units). A frame without amplitudes keeps all. Throws UsageError if image and
/// frame differ in size.
RangeImage drop_low_amplitude(const RangeImage& image, const DualFrequencyFrame& frame,
                              double min_amplitude);

/// Drops pixels whose confidence is below `min_confidence`.
RangeImage drop_low_confidence(const RangeImage& image, double min_confidence);

}  // namespace tofmap
