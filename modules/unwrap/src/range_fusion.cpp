// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/range_fusion.hpp"

#include <cmath>
#include <limits>

#include <tofmap/core/range_image.hpp>

namespace tofmap {

FusedRanges fuse_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                        const BeatLimits& limits, const PhaseNoise& noise) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float agreement = 4;  // standard deviations
  // Noise that may carry B across a wrap boundary leaves no nearest range of B to trust.
  constexpr float largest_sigma_cycles = 0.5F / agreement;
  const auto wavelength_a_m = static_cast<float>(limits.wavelength_a_m);
  const auto wavelength_b_m = static_cast<float>(limits.wavelength_b_m);
  const ImageF sigma_a =
      wavelength_a_m * phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a);
  const ImageF sigma_b =
      wavelength_b_m * phase_sigma_cycles(frame.phase_b, frame.amplitude_b, noise.scale_b);
  FusedRanges out{ImageF::Constant(counts.rows(), counts.cols(), nan), sigma_a};
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.cols(); ++u) {
      if (counts(v, u) == invalid_wrap_count) {
        out.sigma_m(v, u) = nan;
        continue;
      }
      const float phase_a = frame.phase_a(v, u);
      const float range_a_m = (phase_a + static_cast<float>(counts(v, u))) * wavelength_a_m;
      out.range_m(v, u) = range_a_m;
      const float residual_m = beat_residual_m(limits, phase_a, frame.phase_b(v, u), counts(v, u));
      const float variance_a = sigma_a(v, u) * sigma_a(v, u);
      const float variance_b = sigma_b(v, u) * sigma_b(v, u);
      const float variance = variance_a + variance_b;
      const bool is_loud = std::sqrt(variance) > largest_sigma_cycles * wavelength_b_m;
      if (is_loud || residual_m * residual_m > agreement * agreement * variance) continue;
      const float fused_m = range_a_m - residual_m * variance_a / variance;
      if (fused_m <= 0) continue;  // noise just before the camera
      out.range_m(v, u) = fused_m;
      out.sigma_m(v, u) = std::sqrt(variance_a * variance_b / variance);
    }
  }
  return out;
}

}  // namespace tofmap
