// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/range_fusion.hpp"

#include <cmath>
#include <limits>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

constexpr float agreement = 4;  // standard deviations

}  // namespace

RangePair pair_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                      const BeatLimits& limits, const PhaseNoise& noise) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float largest_sigma_cycles = 0.5F / agreement;
  // B is seen from another place; a hand-held camera moves no farther between exposures.
  constexpr float motion_m = 0.1F;
  const auto wavelength_a_m = static_cast<float>(limits.wavelength_a_m);
  const auto wavelength_b_m = static_cast<float>(limits.wavelength_b_m);
  RangePair pair;
  pair.variance_a_m2 =
      (wavelength_a_m * phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a))
          .square();
  pair.variance_b_m2 =
      (wavelength_b_m * phase_sigma_cycles(frame.phase_b, frame.amplitude_b, noise.scale_b))
          .square();
  pair.range_a_m = ImageF::Constant(counts.rows(), counts.cols(), nan);
  pair.residual_m = pair.range_a_m;
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.cols(); ++u) {
      const int count = counts(v, u);
      if (count == invalid_wrap_count) continue;
      const float phase_a = frame.phase_a(v, u);
      pair.range_a_m(v, u) = (phase_a + static_cast<float>(count)) * wavelength_a_m;
      const float residual_m = beat_residual_m(limits, phase_a, frame.phase_b(v, u), count);
      const float sigma_m = std::sqrt(pair.variance_a_m2(v, u) + pair.variance_b_m2(v, u));
      const bool is_loud = sigma_m > largest_sigma_cycles * wavelength_b_m;
      if (is_loud || std::abs(residual_m) > agreement * sigma_m + motion_m) continue;
      pair.residual_m(v, u) = residual_m;
    }
  }
  return pair;
}

FusedRanges fuse_ranges(const RangePair& pair, const ImageF& shrinkage_m) {
  constexpr float calibration_m = 0.01F;
  FusedRanges out{pair.range_a_m, pair.variance_a_m2.sqrt()};
  out.sigma_m = pair.range_a_m.isNaN().select(pair.range_a_m, out.sigma_m);
  for (Eigen::Index v = 0; v < out.range_m.rows(); ++v) {
    for (Eigen::Index u = 0; u < out.range_m.cols(); ++u) {
      if (std::isnan(pair.residual_m(v, u))) continue;
      const float variance_a = pair.variance_a_m2(v, u);
      const float variance_b = pair.variance_b_m2(v, u);
      const float variance = variance_a + variance_b;
      const float residual_m =
          pair.residual_m(v, u) - (shrinkage_m.size() > 0 ? shrinkage_m(v, u) : 0);
      if (std::abs(residual_m) > agreement * std::sqrt(variance) + calibration_m) continue;
      const float fused_m = pair.range_a_m(v, u) - residual_m * variance_a / variance;
      if (fused_m <= 0) continue;  // noise just before the camera
      out.range_m(v, u) = fused_m;
      out.sigma_m(v, u) = std::sqrt(variance_a * variance_b / variance);
    }
  }
  return out;
}

}  // namespace tofmap
