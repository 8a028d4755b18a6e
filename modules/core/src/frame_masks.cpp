// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/frame_masks.hpp"

namespace tofmap {

Image<bool> missing_returns(const Frame& frame) {
  Image<bool> missing = Image<bool>::Constant(frame.rows(), frame.cols(), false);
  for (const ImageF& phase : frame.phases) missing = missing || phase.isNaN();
  return missing;
}

Image<bool> saturated_pixels(const Frame& frame, double saturation_amplitude) {
  Image<bool> saturated = Image<bool>::Constant(frame.rows(), frame.cols(), false);
  if (!frame.has_amplitude() || saturation_amplitude <= 0) return saturated;
  const auto limit = static_cast<float>(saturation_amplitude);
  for (const ImageF& amplitude : frame.amplitudes) saturated = saturated || amplitude >= limit;
  return saturated;
}

}  // namespace tofmap
