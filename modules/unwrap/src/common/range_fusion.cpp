// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/range_fusion.hpp"

#include "common/fast_math.hpp"

#include <cmath>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The ranges of successive pixels so far and their variances; NaN where there is no range.
struct Estimate {
  const float* cycles;  ///< of the first frequency, with its wrap count
  float* range_m;
  float* variance_m2;
};

/// What one more frequency measured of the same pixels.
struct Measured {
  const float* phase;
  const float* sigma_cycles;
  float wavelength_m;
  float residual_variance_m2;  ///< of the residual besides noise
};

/// The cycles of the first frequency with its wrap counts; NaN where the count is invalid.
TOFMAP_VECTOR_CLONES void fill_cycles(int pixels, const float* phase, const std::uint8_t* count,
                                      float* cycles) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const auto counted = static_cast<float>(count[i]);
    const float uncounted = counted == static_cast<float>(invalid_wrap_count) ? nan : 0.0F;
    cycles[i] = phase[i] + counted + uncounted;
  }
}

/// The ranges of the first frequency alone.
TOFMAP_VECTOR_CLONES void start(int pixels, const float* sigma_cycles, float wavelength_m,
                                const Estimate& estimate_) {
  const Estimate estimate = estimate_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float sigma_m = wavelength_m * sigma_cycles[i];
    estimate.range_m[i] = estimate.cycles[i] * wavelength_m;
    estimate.variance_m2[i] = sigma_m * sigma_m;
  }
}

/// Fuses the estimate with one more frequency where the two agree.
TOFMAP_VECTOR_CLONES void fuse(int pixels, const Measured& measured_, float first_wavelength_m,
                               const Estimate& estimate_) {
  constexpr float agreement = residual_agreement_sigmas;
  constexpr float largest_sigma_cycles = 0.5F / agreement;
  const Measured measured = measured_;
  const Estimate estimate = estimate_;
  const float wavelength_m = measured.wavelength_m;
  const float ratio = first_wavelength_m / wavelength_m;
  const float largest_m = largest_sigma_cycles * wavelength_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float sigma_m = wavelength_m * measured.sigma_cycles[i];
    const float other_m2 = sigma_m * sigma_m;
    const float own_m2 = estimate.variance_m2[i];
    const float variance_m2 = own_m2 + other_m2;
    const float range_m = estimate.range_m[i];
    const float both = range_m + measured.phase[i];
    const bool is_present = both == both;
    const float cycles = is_present ? estimate.cycles[i] : 0.0F;
    // What earlier frequencies have changed.
    const float fused_cycles =
        is_present ? (range_m - cycles * first_wavelength_m) / wavelength_m : 0.0F;
    const float residual_m =
        wavelength_m *
        to_half_cycle(cycles * ratio - (is_present ? measured.phase[i] : 0.0F) + fused_cycles);
    const float tolerated_m2 =
        agreement * agreement * (variance_m2 + measured.residual_variance_m2);
    const float fused_m = range_m - residual_m * own_m2 / variance_m2;
    const float fused_m2 = own_m2 * other_m2 / variance_m2;
    const float agrees = residual_m * residual_m <= tolerated_m2 ? 1.0F : 0.0F;
    const float agrees_surely = variance_m2 <= largest_m * largest_m ? agrees : 0.0F;
    // Noise can make the range of a very near surface negative.
    const float fuses = fused_m > 0 ? agrees_surely : 0.0F;
    const bool is_fused = (is_present ? fuses : 0.0F) > 0;
    replace_if(is_fused, fused_m, estimate.range_m[i]);
    replace_if(is_fused, fused_m2, estimate.variance_m2[i]);
  }
}

}  // namespace

FusedRanges fuse_ranges(const Frame& frame, const ImageU8& counts, const UnwrapLimits& limits,
                        const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m) {
  const Eigen::Index rows = counts.rows();
  const Eigen::Index cols = counts.cols();
  const auto pixels = static_cast<int>(counts.size());
  const auto wavelength_m = static_cast<float>(limits.wavelength_m());
  ImageF cycles(rows, cols);
  fill_cycles(pixels, frame.phases.front().data(), counts.data(), cycles.data());
  FusedRanges out{ImageF(rows, cols), ImageF(rows, cols)};
  const Estimate estimate{cycles.data(), out.range_m.data(), out.sigma_m.data()};
  start(pixels, sigma.cycles.front().data(), wavelength_m, estimate);
  for (const std::size_t f : others_by_wavelength(limits.wavelengths_m)) {
    const double systematic_m = residual_sigma_m[f];
    fuse(pixels,
         {frame.phases[f].data(), sigma.cycles[f].data(),
          static_cast<float>(limits.wavelengths_m[f]),
          static_cast<float>(systematic_m * systematic_m)},
         wavelength_m, estimate);
  }
  out.sigma_m = (counts == invalid_wrap_count).select(nan, out.sigma_m.sqrt());
  return out;
}

}  // namespace tofmap
