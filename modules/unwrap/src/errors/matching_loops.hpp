// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

// The loops of exposure_matching.cpp over `count` pixels of a row, written so that the compiler
// vectorises them. Units are metres, cycles and pixels; a flag is 1 or 0. Missing phases are NaN;
// no other input may be NaN.

namespace tofmap::matching {

/// Amplitudes and phase noise of pixels of A and of the corresponding pixels of B.
struct Light {
  const float* amplitude_a;
  const float* amplitude_b;
  const float* sigma_a_cycles;
  const float* sigma_b_cycles;
};

/// Flags the pixels in which A and B agree in amplitude: B's amplitude is A's times `gain` times
/// `nearness` squared, up to same_light_ratio and noise. `nearness` is the range from A divided by
/// the range from B.
void compare_light(int count, const Light& light, const float* nearness, float gain, float* same);

/// Sets phases in `kept` to NaN at the edges of surfaces, where the phase steps or bends by more
/// than `least_cycles` and its noise explain. `before` and `after` are the phases of the neighbours
/// on both sides, along a row or a column. Pixels with a missing neighbour are kept.
void drop_at_ends(int count, const float* phase, const float* sigma_cycles, const float* before,
                  const float* after, float least_cycles, float* kept);

/// x, y and z of the rays of pixels, and of the gradients of their ranges over ray directions.
struct RaysAndGradients {
  const float* ray[3];
  const float* gradient[3];
};

/// Adds the effect of a small motion on the residual to `predicted_m` (docs/unwrapping.md, equation
/// 17), except for the term that depends on the range. That term is `lateral_m2` divided by the
/// range; subtract_lateral() subtracts it.
void add_small_motion(int count, const RaysAndGradients& of, const Eigen::Vector3f& translation_m,
                      const Eigen::Vector3f& rotation_rad, float* predicted_m, float* lateral_m2);
void subtract_lateral(int count, const float* lateral_m2, const float* range_m, float* predicted_m);

/// B's phase plus the predicted residual, wrapped to 0 … 1. An arbitrary number where the phase is
/// missing. `per_wavelength` is 1 / λ_B.
void correct_phase(int count, const float* phase_b, const float* predicted_m, float per_wavelength,
                   float* corrected);

/// A's ranges at the wrap count `wraps`.
void fill_ranges(int count, const float* phase_a, float wraps, float wavelength_m, float* range_m);

/// The nearest pixels of an image to some positions. Outside the image, `index` is 0.
struct ImagePlaces {
  std::int32_t* index;   ///< of the nearest pixel, row by row
  float* off_across_px;  ///< column of the position minus that of the pixel's centre
  float* off_along_px;   ///< row of the position minus that of the pixel's centre
  float* inside;         ///< flags of positions inside the image
};

/// Finds the nearest pixels to the positions `col_px`, `row_px` in an image of rows x cols pixels.
void find_places(int count, const float* col_px, const float* row_px, Eigen::Index rows,
                 Eigen::Index cols, const ImagePlaces& places);

/// Reads the pixels of an image at these indices.
void gather(int count, const float* image, const std::int32_t* index, float* values);

/// Sets phases outside the image to NaN.
void drop_outside(int count, const float* inside, float* phase);

/// Slopes of A's range, metres per pixel (SurfaceSlopes).
struct Slopes {
  const float* across_m;  ///< per column
  const float* along_m;   ///< per row
  const float* rough_m;   ///< steepness where the surface bends or ends
};

/// Adds the effect of B's position on the residual to `predicted_m`: by how much the range is
/// shorter from B, and how much the surface rises between the centre of B's pixel and the position.
/// Fills in `nearness`, the range from A divided by the range from B.
void add_place(int count, const Slopes& slopes, const ImagePlaces& places, const float* range_m,
               const float* shrinkage_m, float* predicted_m, float* nearness);

/// The input of find_residuals().
struct Residual {
  const float* phase_a;
  const float* phase_b;
  const float* predicted_m;
  float wavelength_ratio;  ///< λ_A / λ_B
  float per_wavelength;    ///< 1 / λ_B
};

/// Writes the residual at wrap count 0 minus the prediction to `cycles`, in cycles of B and not
/// wrapped, and A's phase to `limited_phase`. Where a phase is missing, `limited_phase` is so large
/// that keep_least() takes no wrap count.
void find_residuals(int count, const Residual& of, float* cycles, float* limited_phase);

/// Lowers `least_cycles`, the smallest absolute residual so far, in pixels that one more wrap count
/// fits better. That wrap count adds `shift_cycles` to the residual, and is within the limits for
/// phases up to `farthest_cycles`.
void keep_least(int count, const float* cycles, const float* limited_phase, float shift_cycles,
                float farthest_cycles, float* least_cycles);

/// Pixels of B.
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
/// Copies the pixels of `from` to `best` whose amplitude agrees (`same`) and whose residual
/// `least_cycles` is smaller than `best_cycles`, which is lowered accordingly.
void take_better(int count, const float* least_cycles, const float* same, const BPixels& from,
                 float* best_cycles, const MutableBPixels& best);

/// Adds to B's noise the error that an uncertain position in B causes on a sloped surface.
/// `place_per_m` and `rough_place_per_m` are the standard deviations of the position, in pixels,
/// divided by B's wavelength: where the slope is known, and where the surface bends or ends.
void add_place_noise(int count, const Slopes& slopes, float place_per_m, float rough_place_per_m,
                     float* sigma_cycles);

/// Fills in B's phases before anything was matched: the phase of the same pixel, 0 where it is
/// missing, and NaN where A's phase is missing.
void start_unseen(int count, const float* phase_a, const float* phase_b, float* phase);

/// Clears the flags of pixels in which a phase is missing.
void clear_missing(int count, const float* phase_a, const float* phase_b, float* flags);

/// Clears the flags of pixels that were not found now, or that were seen before.
void keep_new(int count, const float* best_cycles, const float* sigma_before_cycles, float* flags);

/// Copies the flagged pixels.
void store(int count, const float* flags, const BPixels& from, const MutableBPixels& to);

/// Copies the phases `from` of pixels in which neither A's nor B's phase is missing.
void store_phases(int count, const float* phase_a, const float* phase_b, const float* from,
                  float* to);

}  // namespace tofmap::matching
