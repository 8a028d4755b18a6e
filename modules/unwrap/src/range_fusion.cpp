// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/range_fusion.hpp"

#include "fast_math.hpp"

#include <cmath>
#include <limits>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float agreement = 4;  // standard deviations

/// Pixels of both frequencies.
struct Pixels {
  const float* phase_a;
  const float* phase_b;
  const std::uint8_t* count;
  const float* sigma_a;  ///< of the phase, cycles
  const float* sigma_b;
};

/// The planes of a RangePair.
struct PairPlanes {
  float* range_a_m;
  float* residual_m;
  float* variance_a_m2;
  float* variance_b_m2;
};

TOFMAP_VECTOR_CLONES void fill_pair(int count, const Pixels& pixels_, float wavelength_a_m,
                                    float wavelength_b_m, const PairPlanes& out_) {
  constexpr float largest_sigma_cycles = 0.5F / agreement;
  // B is seen from another place; a hand-held camera moves no farther between exposures.
  constexpr float motion_m = 0.1F;
  const Pixels pixels = pixels_;
  const PairPlanes out = out_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float sigma_a_m = wavelength_a_m * pixels.sigma_a[i];
    const float sigma_b_m = wavelength_b_m * pixels.sigma_b[i];
    const float variance_a_m2 = sigma_a_m * sigma_a_m;
    const float variance_b_m2 = sigma_b_m * sigma_b_m;
    const auto counted = static_cast<float>(pixels.count[i]);
    const float uncounted = counted == static_cast<float>(invalid_wrap_count) ? nan : 0.0F;
    const float range_m = (pixels.phase_a[i] + counted) * wavelength_a_m + uncounted;
    const float beat = range_m / wavelength_b_m - pixels.phase_b[i];
    const float residual_m = to_half_cycle(beat == beat ? beat : 0.0F) * wavelength_b_m;
    const float sigma_m = std::sqrt(variance_a_m2 + variance_b_m2);
    const float tolerated_m =
        sigma_m <= largest_sigma_cycles * wavelength_b_m ? agreement * sigma_m + motion_m : -1.0F;
    const float size_m = residual_m < 0 ? -residual_m : residual_m;
    // Sums, unlike choices, leave the compiler no branch.
    const float unsure = size_m <= tolerated_m ? 0.0F : nan;
    out.range_a_m[i] = range_m;
    out.residual_m[i] = residual_m + unsure + uncounted;
    out.variance_a_m2[i] = variance_a_m2;
    out.variance_b_m2[i] = variance_b_m2;
  }
}

/// B's residuals without what motion makes of them, if they agree with A then; fused with A.
TOFMAP_VECTOR_CLONES void fill_fused(int count, const float* range_a_m, const float* residual_m,
                                     const float* variance_a_m2, const float* variance_b_m2,
                                     const float* shrinkage_m, float* range_m, float* sigma_m) {
  constexpr float calibration_m = 0.01F;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float variance = variance_a_m2[i] + variance_b_m2[i];
    const float residual = residual_m[i] - shrinkage_m[i];
    const float fused_m = range_a_m[i] - residual * variance_a_m2[i] / variance;
    const float fused_variance = variance_a_m2[i] * variance_b_m2[i] / variance;
    const bool agrees = std::abs(residual) <= agreement * std::sqrt(variance) + calibration_m;
    const bool is_fused = agrees && fused_m > 0;  // noise just before the camera
    const float absent = 0 * range_a_m[i];
    range_m[i] = is_fused ? fused_m : range_a_m[i];
    sigma_m[i] = std::sqrt(is_fused ? fused_variance : variance_a_m2[i]) + absent;
  }
}

}  // namespace

RangePair pair_ranges(const DualFrequencyFrame& frame, const ImageU8& counts,
                      const BeatLimits& limits, const PhaseSigma& sigma) {
  RangePair pair;
  for (ImageF* plane :
       {&pair.range_a_m, &pair.residual_m, &pair.variance_a_m2, &pair.variance_b_m2}) {
    plane->resize(counts.rows(), counts.cols());
  }
  fill_pair(static_cast<int>(counts.size()),
            {frame.phase_a.data(), frame.phase_b.data(), counts.data(), sigma.a_cycles.data(),
             sigma.b_cycles.data()},
            static_cast<float>(limits.wavelength_a_m), static_cast<float>(limits.wavelength_b_m),
            {pair.range_a_m.data(), pair.residual_m.data(), pair.variance_a_m2.data(),
             pair.variance_b_m2.data()});
  return pair;
}

FusedRanges fuse_ranges(const RangePair& pair, const ImageF& shrinkage_m) {
  const Eigen::Index rows = pair.range_a_m.rows();
  const Eigen::Index cols = pair.range_a_m.cols();
  const ImageF still = shrinkage_m.size() > 0 ? ImageF() : ImageF::Zero(rows, cols);
  FusedRanges out{ImageF(rows, cols), ImageF(rows, cols)};
  fill_fused(static_cast<int>(pair.range_a_m.size()), pair.range_a_m.data(), pair.residual_m.data(),
             pair.variance_a_m2.data(), pair.variance_b_m2.data(),
             shrinkage_m.size() > 0 ? shrinkage_m.data() : still.data(), out.range_m.data(),
             out.sigma_m.data());
  return out;
}

}  // namespace tofmap
