// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/range_fusion.hpp"

#include "common/fast_math.hpp"

#include <cmath>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The measurements of successive pixels and their wrap counts.
struct Pixels {
  const float* phase_a;
  const float* phase_b;
  const std::uint8_t* count;
  const float* sigma_a;  ///< noise of phase_a, cycles
  const float* sigma_b;
};

TOFMAP_VECTOR_CLONES void fill_fused(int count, const Pixels& pixels_, float wavelength_a_m,
                                     float wavelength_b_m, float residual_variance_m2,
                                     float* range_m, float* sigma_m) {
  constexpr float agreement = residual_agreement_sigmas;
  constexpr float largest_sigma_cycles = 0.5F / agreement;
  const Pixels pixels = pixels_;
  const float ratio = wavelength_a_m / wavelength_b_m;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float sigma_a_m = wavelength_a_m * pixels.sigma_a[i];
    const float sigma_b_m = wavelength_b_m * pixels.sigma_b[i];
    const float variance_a_m2 = sigma_a_m * sigma_a_m;
    const float variance_b_m2 = sigma_b_m * sigma_b_m;
    const float variance_m2 = variance_a_m2 + variance_b_m2;
    const auto counted = static_cast<float>(pixels.count[i]);
    const float uncounted = counted == static_cast<float>(invalid_wrap_count) ? nan : 0.0F;
    const float cycles_a = pixels.phase_a[i] + counted;
    const float both = cycles_a + pixels.phase_b[i];
    const bool is_present = both == both;
    const float residual_m =
        wavelength_b_m * frequency_residual_cycles(is_present ? cycles_a : 0.0F,
                                                   is_present ? pixels.phase_b[i] : 0.0F, ratio);
    const float tolerated_m2 = agreement * agreement * (variance_m2 + residual_variance_m2);
    const float largest_m = largest_sigma_cycles * wavelength_b_m;
    const float range_a_m = cycles_a * wavelength_a_m;
    const float fused_m = range_a_m - residual_m * variance_a_m2 / variance_m2;
    const float fused_variance_m2 = variance_a_m2 * variance_b_m2 / variance_m2;
    const float agrees = residual_m * residual_m <= tolerated_m2 ? 1.0F : 0.0F;
    const float agrees_surely = variance_m2 <= largest_m * largest_m ? agrees : 0.0F;
    // Noise can make the range of a very near surface negative.
    const float fuses = fused_m > 0 ? agrees_surely : 0.0F;
    const bool is_fused = (is_present ? fuses : 0.0F) > 0;
    range_m[i] = (is_fused ? fused_m : range_a_m) + uncounted;
    sigma_m[i] = std::sqrt(is_fused ? fused_variance_m2 : variance_a_m2) + uncounted;
  }
}

}  // namespace

FusedRanges fuse_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                        const UnwrapLimits& limits, const PhaseSigma& sigma,
                        double residual_sigma_m) {
  FusedRanges out{ImageF(counts.rows(), counts.cols()), ImageF(counts.rows(), counts.cols())};
  fill_fused(static_cast<int>(counts.size()),
             {frame.phase_a.data(), frame.phase_b.data(), counts.data(), sigma.a_cycles.data(),
              sigma.b_cycles.data()},
             static_cast<float>(limits.wavelength_a_m), static_cast<float>(limits.wavelength_b_m),
             static_cast<float>(residual_sigma_m * residual_sigma_m), out.range_m.data(),
             out.sigma_m.data());
  return out;
}

}  // namespace tofmap
