// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/matching_loops.hpp"

#include "common/fast_math.hpp"
#include "errors/exposure_pair.hpp"
#include "errors/surface_slopes.hpp"

#include <cmath>
#include <numbers>

#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap::matching {
TOFMAP_VECTOR_CLONES void compare_light(int count, const Light& light_, const float* nearness,
                                        float gain, float* same) {
  // Noise of this many standard deviations is tolerated in addition to same_light_ratio.
  constexpr float ratio_sigmas = 4;
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  const Light light = light_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float expected = light.amplitude_a[i] * gain * nearness[i] * nearness[i];
    const float measured = light.amplitude_b[i];
    const float greater = expected > measured ? expected : measured;
    const float lesser = expected > measured ? measured : expected;
    const float sigma_a = light.sigma_a_cycles[i];
    const float sigma_b = light.sigma_b_cycles[i];
    const float noise = turn * std::sqrt(sigma_a * sigma_a + sigma_b * sigma_b);
    // `noise` is that of the logarithm of the ratio; exp is replaced by its first-order expansion.
    const float tolerated = same_light_ratio * (1 + ratio_sigmas * noise);
    same[i] = greater <= tolerated * lesser ? 1.0F : 0.0F;
  }
}

TOFMAP_VECTOR_CLONES void drop_at_ends(int count, const float* phase, const float* sigma_cycles,
                                       const float* before, const float* after, float least_cycles,
                                       float* kept) {
  constexpr float sigmas = 4 * 2.45F;  // second differences have √6 times the noise of a phase
  constexpr float share_of_rise = 0.5F;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float rise = phase[i] - before[i];
    const float next = after[i] - phase[i];
    const bool is_whole = rise + next == rise + next;
    const float to_here = to_half_cycle(is_whole ? rise : 0.0F);
    const float from_here = to_half_cycle(is_whole ? next : 0.0F);
    const float tolerated = sigmas * sigma_cycles[i] + least_cycles;
    const bool goes_on = is_straight(to_here, from_here, tolerated, share_of_rise);
    kept[i] = goes_on ? kept[i] : nan;
  }
}

TOFMAP_VECTOR_CLONES void add_small_motion(int count, const RaysAndGradients& of,
                                           const Eigen::Vector3f& translation_m,
                                           const Eigen::Vector3f& rotation_rad, float* predicted_m,
                                           float* lateral_m2) {
  const auto [ux, uy, uz] = of.ray;
  const auto [qx, qy, qz] = of.gradient;
  const float tx = translation_m.x(), ty = translation_m.y(), tz = translation_m.z();
  const float wx = rotation_rad.x(), wy = rotation_rad.y(), wz = rotation_rad.z();
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float cx = wy * uz[i] - wz * uy[i];
    const float cy = wz * ux[i] - wx * uz[i];
    const float cz = wx * uy[i] - wy * ux[i];
    predicted_m[i] += ux[i] * tx + uy[i] * ty + uz[i] * tz - (qx[i] * cx + qy[i] * cy + qz[i] * cz);
    lateral_m2[i] = qx[i] * tx + qy[i] * ty + qz[i] * tz;
  }
}

TOFMAP_VECTOR_CLONES void subtract_lateral(int count, const float* lateral_m2, const float* range_m,
                                           float* predicted_m) {
  constexpr float nearest_m = 0.1F;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    predicted_m[i] -= lateral_m2[i] / (range_m[i] > nearest_m ? range_m[i] : nearest_m);
  }
}

TOFMAP_VECTOR_CLONES void correct_phase(int count, const float* phase_b, const float* predicted_m,
                                        float per_wavelength, float* corrected) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float cycles = phase_b[i] + predicted_m[i] * per_wavelength;
    const float wrapped = to_half_cycle(cycles == cycles ? cycles : 0.0F);
    const float positive = wrapped < 0 ? wrapped + 1 : wrapped;
    corrected[i] = positive < 1 ? positive : 0.0F;
  }
}

TOFMAP_VECTOR_CLONES void fill_ranges(int count, const float* phase_a, float wraps,
                                      float wavelength_m, float* range_m) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) range_m[i] = (phase_a[i] + wraps) * wavelength_m;
}

TOFMAP_VECTOR_CLONES void find_places(int count, const float* col_px, const float* row_px,
                                      Eigen::Index rows, Eigen::Index cols,
                                      const ImagePlaces& places_) {
  const ImagePlaces places = places_;
  const auto width = static_cast<std::int32_t>(cols);
  const float last_col = static_cast<float>(cols) - 0.5F;
  const float last_row = static_cast<float>(rows) - 0.5F;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float across = col_px[i] > -0.5F ? 1.0F : 0.0F;
    const float not_right = col_px[i] < last_col ? across : 0.0F;
    const float not_above = row_px[i] > -0.5F ? not_right : 0.0F;
    const float inside = row_px[i] < last_row ? not_above : 0.0F;
    const float col = inside > 0 ? col_px[i] : 0.0F;
    const float row = inside > 0 ? row_px[i] : 0.0F;
    // To the nearest pixel: neither is negative, and std::lround is not vectorised.
    const float col_up = col + 0.5F;
    const float row_up = row + 0.5F;
    const auto u = static_cast<std::int32_t>(col_up);
    const auto v = static_cast<std::int32_t>(row_up);
    places.index[i] = v * width + u;
    places.off_across_px[i] = col - static_cast<float>(u);
    places.off_along_px[i] = row - static_cast<float>(v);
    places.inside[i] = inside;
  }
}

TOFMAP_VECTOR_CLONES void gather(int count, const float* image, const std::int32_t* index,
                                 float* values) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) values[i] = image[index[i]];
}

TOFMAP_VECTOR_CLONES void drop_outside(int count, const float* inside, float* phase) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) phase[i] = inside[i] > 0 ? phase[i] : nan;
}

TOFMAP_VECTOR_CLONES void add_place(int count, const Slopes& slopes_, const ImagePlaces& places_,
                                    const float* range_m, const float* shrinkage_m,
                                    float* predicted_m, float* nearness) {
  constexpr float nearest_m = 0.01F;
  const Slopes slopes = slopes_;
  const ImagePlaces places = places_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    predicted_m[i] += shrinkage_m[i] + slopes.across_m[i] * places.off_across_px[i] +
                      slopes.along_m[i] * places.off_along_px[i];
    const float from_b_m = range_m[i] - shrinkage_m[i];
    nearness[i] = range_m[i] / (from_b_m > nearest_m ? from_b_m : nearest_m);
  }
}

TOFMAP_VECTOR_CLONES void find_residuals(int count, const Residual& of_, float* cycles,
                                         float* limited_phase) {
  constexpr float beyond_limits = 1e9F;
  const Residual of = of_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float residual =
        of.phase_a[i] * of.wavelength_ratio - of.phase_b[i] - of.predicted_m[i] * of.per_wavelength;
    const bool is_present = residual == residual;
    cycles[i] = is_present ? residual : 0.0F;
    limited_phase[i] = is_present ? of.phase_a[i] : beyond_limits;
  }
}

TOFMAP_VECTOR_CLONES void keep_least(int count, const float* cycles, const float* limited_phase,
                                     float shift_cycles, float farthest_cycles,
                                     float* least_cycles) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float off = to_half_cycle(cycles[i] + shift_cycles);
    const float size = off < 0 ? -off : off;
    const float better = size < least_cycles[i] ? size : least_cycles[i];
    least_cycles[i] = limited_phase[i] <= farthest_cycles ? better : least_cycles[i];
  }
}

TOFMAP_VECTOR_CLONES void take_better(int count, const float* least_cycles, const float* same,
                                      const BPixels& from_, float* best_cycles,
                                      const MutableBPixels& best_) {
  const BPixels from = from_;
  const MutableBPixels best = best_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float least = least_cycles[i];
    const float before = best_cycles[i];
    const float size = same[i] > 0 ? least : 2.0F;
    const bool is_better = size < before;
    best_cycles[i] = is_better ? size : before;
    replace_if(is_better, from.phase[i], best.phase[i]);
    replace_if(is_better, from.amplitude[i], best.amplitude[i]);
    replace_if(is_better, from.sigma_cycles[i], best.sigma_cycles[i]);
  }
}

TOFMAP_VECTOR_CLONES void add_place_noise(int count, const Slopes& slopes_, float place_per_m,
                                          float rough_place_per_m, float* sigma_cycles) {
  const Slopes slopes = slopes_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float across = place_per_m * slopes.across_m[i];
    const float along = place_per_m * slopes.along_m[i];
    const float rough = rough_place_per_m * slopes.rough_m[i];
    sigma_cycles[i] = std::sqrt(sigma_cycles[i] * sigma_cycles[i] + across * across +
                                along * along + rough * rough);
  }
}

TOFMAP_VECTOR_CLONES void start_unseen(int count, const float* phase_a, const float* phase_b,
                                       float* phase) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float known = phase_b[i] == phase_b[i] ? phase_b[i] : 0.0F;
    phase[i] = phase_a[i] == phase_a[i] ? known : nan;
  }
}

TOFMAP_VECTOR_CLONES void clear_missing(int count, const float* phase_a, const float* phase_b,
                                        float* flags) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float both = phase_a[i] + phase_b[i];
    flags[i] = both == both ? flags[i] : 0.0F;
  }
}

TOFMAP_VECTOR_CLONES void keep_new(int count, const float* best_cycles,
                                   const float* sigma_before_cycles, float* flags) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float found = best_cycles[i] < 1 ? flags[i] : 0.0F;
    flags[i] = sigma_before_cycles[i] == MatchedExposure::unseen_sigma_cycles ? found : 0.0F;
  }
}

TOFMAP_VECTOR_CLONES void store(int count, const float* flags, const BPixels& from_,
                                const MutableBPixels& to_) {
  const BPixels from = from_;
  const MutableBPixels to = to_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const bool seen = flags[i] > 0;
    replace_if(seen, from.phase[i], to.phase[i]);
    replace_if(seen, from.amplitude[i], to.amplitude[i]);
    replace_if(seen, from.sigma_cycles[i], to.sigma_cycles[i]);
  }
}

TOFMAP_VECTOR_CLONES void store_phases(int count, const float* phase_a, const float* phase_b,
                                       const float* from, float* to) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float both = phase_a[i] + phase_b[i];
    to[i] = both == both ? from[i] : to[i];
  }
}

}  // namespace tofmap::matching
