// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "inverse_depth.hpp"

#include <cstddef>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// The depth that A measured minus the nearest that B's phase allows, of every pixel, metres. NaN
/// where the pixel is invalid, and in a margin around the image, as in InverseDepth.
///
/// Its noise follows the amplitudes, σ² = s² ((λ_A / a_A)² + (λ_B / a_B)²), at a scale s that the
/// differences between neighbours tell: half of them lie within their median. So nothing that both
/// of two neighbours are off by, such as an offset between the frequencies, is taken for noise.
class FrequencyDifference {
 public:
  /// Throws UsageError if image, frame and rays differ in size.
  FrequencyDifference(const RangeImage& image, const DualFrequencyFrame& frame,
                      const Modulation& modulation, const PixelRays& rays);

  /// The first pixel of a row.
  const float* value(int row) const { return values_.data() + place(row); }
  const float* variance(int row) const { return variances_.data() + place(row); }

 private:
  double noise_scale() const;

  std::size_t place(int row) const {
    return static_cast<std::size_t>((row + InverseDepth::margin) * stride_ + InverseDepth::margin);
  }

  int rows_;
  int cols_;
  int stride_;
  std::vector<float> values_;
  std::vector<float> variances_;  ///< m²
};

}  // namespace tofmap
