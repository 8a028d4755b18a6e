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

/// For each pixel, the depth that the first frequency, A, measured minus the nearest depth that the
/// phase of another one, B, allows, metres. B is the one with the shortest wavelength, which
/// measures most precisely. NaN where the pixel is invalid, and in a margin around the image, as in
/// InverseDepth. With one frequency, all differences and their variances are 0.
///
/// The noise follows the amplitudes, σ² = s² ((λ_A / a_A)² + (λ_B / a_B)²). The scale s is
/// estimated from the median of the differences between neighbours, so that an error that both
/// neighbours have, such as an offset between the frequencies, is not taken for noise.
class FrequencyDifference {
 public:
  /// Throws UsageError if image, frame and rays differ in size.
  FrequencyDifference(const RangeImage& image, const Frame& frame, const Modulation& modulation,
                      const PixelRays& rays);

  /// The difference at the first pixel of a row, metres. The rest of the row follows it.
  const float* value(int row) const { return values_.data() + place(row); }

  /// The variance of the difference at the first pixel of a row, m².
  const float* variance(int row) const { return variances_.data() + place(row); }

 private:
  /// Sets the differences of valid pixels to 0.
  void set_equal(const RangeImage& image);

  /// The scale s; 0 if no two neighbours have a difference.
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
