// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops pixels whose amplitude, the weakest one of all frequencies, is below `min_amplitude`, in
/// the units of the camera. Keeps all pixels if the frame has no amplitudes. Dropped pixels get the
/// reason `low_amplitude`. Throws UsageError if image and frame differ in size.
RangeImage drop_low_amplitude(const RangeImage& image, const Frame& frame, double min_amplitude);

/// Drops pixels whose confidence is below `min_confidence`, 0 … 1. Dropped pixels get the reason
/// `low_confidence`.
RangeImage drop_low_confidence(const RangeImage& image, double min_confidence);

}  // namespace tofmap
