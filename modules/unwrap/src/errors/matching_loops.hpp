// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

// The loops of exposure_matching.cpp over `count` pixels of a row, as vector instructions. Metres,
// cycles and pixels; a flag is 1 or 0. Phases are NaN where there is none; nothing else may be.

namespace tofmap::matching {

/// Amplitudes and noise of pixels of A, and those of B that are compared with them.
struct Light {
  const float* amplitude_a;
  const float* amplitude_b;
  const float* sigma_a_cycles;
  const float* sigma_b_cycles;
};

/// Flags the pixels in which both see the same light: B's amplitude is A's times `gain` and the
/// square of `nearness`, the ratio of the range from A's place to that from B's.
void compare_light(int count, const Light& light, const float* nearness, float gain, float* same);

/// Takes phases of B away beside the ends of surfaces: where it steps or bends by more than
/// `least_cycles`. `before` and `after` are those on both sides, along a row or a column; where one
/// is missing nothing ends.
void drop_at_ends(int count, const float* phase, const float* sigma_cycles, const float* before,
                  const float* after, float least_cycles, float* kept);

/// Rays of pixels and the gradients of their range on the sphere of rays.
struct RaysAndGradients {
  const float* ray[3];
  const float* gradient[3];
};

/// Adds what a small motion makes of the residual (docs/unwrapping.md, equation 17), up to what
/// depends on the range: `lateral_m2` over the range is to be subtracted.
void add_small_motion(int count, const RaysAndGradients& of, const Eigen::Vector3f& translation_m,
                      const Eigen::Vector3f& rotation_rad, float* predicted_m, float* lateral_m2);
void subtract_lateral(int count, const float* lateral_m2, const float* range_m, float* predicted_m);

/// B's phase plus what is predicted of the residual, 0 … 1; any number where there is no phase.
void correct_phase(int count, const float* phase_b, const float* predicted_m, float per_wavelength,
                   float* corrected);

/// A's ranges at one wrap count.
void fill_ranges(int count, const float* phase_a, float wraps, float wavelength_m, float* range_m);

/// Where pixels lie in an image: its pixel, 0 outside; how far they lie from its centre; and flags
/// of those inside.
struct ImagePlaces {
  std::int32_t* index;
  float* off_across_px;
  float* off_along_px;
  float* inside;
};
void find_places(int count, const float* col_px, const float* row_px, Eigen::Index rows,
                 Eigen::Index cols, const ImagePlaces& places);

/// The pixels of an image at these places.
void gather(int count, const float* image, const std::int32_t* index, float* values);

/// Leaves phases inside the image alone.
void drop_outside(int count, const float* inside, float* phase);

/// How far surfaces rise per pixel.
struct Slopes {
  const float* across_m;
  const float* along_m;
  const float* rough_m;  ///< where the surface bends or ends
};

/// Adds what B's place changes of the residual: how much shorter the range is from there, and what
/// the surface rises by within the pixel. Fills in the ratio of both ranges.
void add_place(int count, const Slopes& slopes, const ImagePlaces& places, const float* range_m,
               const float* shrinkage_m, float* predicted_m, float* nearness);

/// What residuals, less what is predicted of them, are made of.
struct Residual {
  const float* phase_a;
  const float* phase_b;
  const float* predicted_m;
  float wavelength_ratio;
  float per_wavelength;
};
/// The residuals of wrap count 0, and A's phases, those of pixels that lack one beyond all limits.
void find_residuals(int count, const Residual& of, float* cycles, float* limited_phase);

/// Lowers `least_cycles` where a wrap count fits better, which adds `shift_cycles` to the residual,
/// and is within the limits up to the phase `farthest_cycles`.
void keep_least(int count, const float* cycles, const float* limited_phase, float shift_cycles,
                float farthest_cycles, float* least_cycles);

/// B's pixels, found in one place or in the best of several.
struct BPixels {
  const float* phase;
  const float* amplitude;
  const float* sigma_cycles;
};
struct MutableBPixels {
  float* phase;
  float* amplitude;
  float* sigma_cycles;
};
/// Takes over those of `from` that see the same light and fit better than the best so far.
void take_better(int count, const float* least_cycles, const float* same, const BPixels& from,
                 float* best_cycles, const MutableBPixels& best);

/// Adds the uncertainty of B's place, on the surface's slope, to B's noise: standard deviations
/// over B's wavelength where slopes make up for a part of a pixel, and where they do not.
void add_place_noise(int count, const Slopes& slopes, float place_per_m, float rough_place_per_m,
                     float* sigma_cycles);

/// B as if nothing of it was seen: its phase, 0 where there is none, and none without A's.
void start_unseen(int count, const float* phase_a, const float* phase_b, float* phase);

/// Clears the flags of pixels that lack one of the phases.
void clear_missing(int count, const float* phase_a, const float* phase_b, float* flags);

/// Clears the flags of pixels that were not found now, or seen before.
void keep_new(int count, const float* best_cycles, const float* sigma_before_cycles, float* flags);

/// Takes over the pixels that are flagged.
void store(int count, const float* flags, const BPixels& from, const MutableBPixels& to);

/// Takes over phases where both frequencies have one.
void store_phases(int count, const float* phase_a, const float* phase_b, const float* from,
                  float* to);

}  // namespace tofmap::matching
