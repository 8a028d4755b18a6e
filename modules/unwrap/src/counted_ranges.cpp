// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "counted_ranges.hpp"

namespace tofmap {

RangeImage make_range_image(const ImageF& range_m, const ImageF& sigma_m, const ImageU8& counts,
                            const ImageF& confidence) {
  RangeImage image(counts.rows(), counts.cols());
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      if (counts(v, u) == invalid_wrap_count) continue;
      image.range_m(v, u) = range_m(v, u);
      image.sigma_m(v, u) = sigma_m(v, u);
      image.wrap_count(v, u) = counts(v, u);
      image.confidence(v, u) = confidence(v, u);
      image.reason(v, u) = static_cast<std::uint8_t>(InvalidReason::none);
    }
  }
  return image;
}

RangeImage make_range_image(const DualFrequencyFrame& frame, const ImageU8& counts,
                            const ImageF& confidence, const BeatLimits& limits,
                            const PhaseNoise& noise) {
  const auto wavelength_m = static_cast<float>(limits.wavelength_a_m);
  const ImageF range_m = (frame.phase_a + counts.cast<float>()) * wavelength_m;
  const ImageF sigma_m =
      phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a) * wavelength_m;
  return make_range_image(range_m, sigma_m, counts, confidence);
}

}  // namespace tofmap
