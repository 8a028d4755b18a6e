// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "counted_ranges.hpp"

namespace tofmap {

RangeImage make_range_image(const DualFrequencyFrame& frame, const ImageU8& counts,
                            const ImageF& confidence, const BeatLimits& limits,
                            const PhaseNoise& noise) {
  const ImageF sigma = phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a);
  const auto wavelength_m = static_cast<float>(limits.wavelength_a_m);
  RangeImage image(frame.phase_a.rows(), frame.phase_a.cols());
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      if (counts(v, u) == invalid_wrap_count) continue;
      image.range_m(v, u) = (frame.phase_a(v, u) + counts(v, u)) * wavelength_m;
      image.sigma_m(v, u) = sigma(v, u) * wavelength_m;
      image.wrap_count(v, u) = counts(v, u);
      image.confidence(v, u) = confidence(v, u);
      image.reason(v, u) = static_cast<std::uint8_t>(InvalidReason::none);
    }
  }
  return image;
}

}  // namespace tofmap
