// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/filters/isolated_wrap_filter.hpp>
#include <tofmap/filters/phasor_mean_filter.hpp>
#include <tofmap/filters/plane_edge_filter.hpp>
#include <tofmap/filters/smooth_filter.hpp>
#include <tofmap/filters/step_edge_filter.hpp>

namespace tofmap {

/// The filters that can run after unwrapping, by the names that users give.
enum class Filter {
  amplitude,      ///< drop_low_amplitude()
  confidence,     ///< drop_low_confidence()
  phasor_mean,    ///< average_phasors()
  isolated_wrap,  ///< mend_isolated_wraps()
  jump_edge,      ///< drop_jump_edges()
  step_edge,      ///< drop_steps()
  plane_edge,     ///< drop_off_planes()
  outlier,        ///< drop_outliers()
  smooth,         ///< smooth_ranges()
};

std::span<const NamedValue<Filter>> named_values(Filter);

/// Options of the filters that run after unwrapping (docs/filters.md). Each limit has an effect
/// only if its filter is in `chain`.
struct FilterOptions {
  /// The filters in the order in which they run. No filter runs if it is empty.
  std::vector<Filter> chain = {Filter::amplitude, Filter::confidence, Filter::phasor_mean,
                               Filter::isolated_wrap, Filter::plane_edge};

  /// `amplitude`: drops pixels whose weakest amplitude of all frequencies is below this, in the
  /// units of the camera, 0 … 1e9. 0 keeps all pixels.
  double min_amplitude = 0;

  /// `confidence`: drops pixels whose confidence in their wrap count is below this, 0 … 1. 0 keeps
  /// all pixels.
  double min_confidence = 0;

  /// `phasor_mean`: averages only pixels whose range noise exceeds this fraction of λ_A, 0 … 1.
  double min_phasor_noise_cycles = PhasorMeanLimits{}.min_noise_cycles;

  /// `phasor_mean`: largest radius of the averaging windows, 0 … 64 pixels. Values below 2 turn the
  /// filter off.
  double max_phasor_radius_px = PhasorMeanLimits{}.max_radius_px;

  /// `isolated_wrap`: leaves regions alone that are larger than this fraction of the image, 0 … 1.
  double max_isolated_share = IsolatedWrapLimits{}.max_share;

  /// `jump_edge`: drops a pixel if the angle at its point, between the line to the optical centre
  /// and the line to a neighbouring point, exceeds this, 90 … 180 degrees. 180 drops no pixel.
  double max_edge_angle_deg = 170;

  /// `jump_edge`: ignores neighbours that are closer to the pixel's point than this many standard
  /// deviations of the range error, 0 … 100. 0 is the filter as published.
  double min_edge_gap_sigmas = 5;

  /// `step_edge`: steepest surface that is not taken for a step, as the angle of incidence of the
  /// ray, 0 … 89.9 degrees. Larger angles drop fewer pixels.
  double max_step_incidence_deg = StepEdgeLimits{}.max_incidence_deg;

  /// `step_edge`: standard deviations of the range error that are added to the smallest height of a
  /// step, 0 … 100. Larger values drop fewer pixels.
  double min_step_sigmas = StepEdgeLimits{}.min_sigmas;

  /// `plane_edge`: how far a pixel that is not at a step may lie off the planes around it, in
  /// standard deviations, 0 … 100. Smaller values drop more pixels.
  double max_plane_sigmas = PlaneEdgeLimits{}.max_sigmas;

  /// `plane_edge`: the limit for pixels at a step between two surfaces, in standard deviations,
  /// 0 … 100. Smaller values drop more flying pixels, and more pixels of surfaces.
  double max_edge_sigmas = PlaneEdgeLimits{}.max_edge_sigmas;

  /// `plane_edge`: deviation in depth from a plane that is always accepted, 0 … 10 m. It is added
  /// to the two limits above in quadrature.
  double plane_tolerance_m = PlaneEdgeLimits{}.tolerance_m;

  /// `smooth`: averages a pixel only with pixels that differ from it by fewer standard deviations
  /// than this, 0 … 100.
  double max_smooth_sigmas = SmoothLimits{}.max_sigmas;

  /// `smooth`: difference in depth up to which pixels are always averaged, 0 … 10 m. It is added to
  /// the limit above in quadrature.
  double smooth_tolerance_m = SmoothLimits{}.tolerance_m;

  /// `outlier`: drops points whose spacing to their neighbours exceeds the median of the image by
  /// more than this many standard deviations, 0 … 1000.
  double max_outlier_deviations = 5;

  static std::vector<OptionField<FilterOptions>> fields();
};

/// The default chain, followed by `smooth`: for ranges that are the final result. Maps do not use
/// it, because they fit planes to the ranges, which smooths better, and because noise that
/// neighbouring pixels share would look like the shape of a surface.
std::vector<Filter> smoothing_chain();

/// What one filter of the chain did.
struct FilterCount {
  Filter filter = Filter::amplitude;
  InvalidReason reason = InvalidReason::none;  ///< of the dropped pixels; none if it drops nothing
  int removed = 0;                             ///< number of pixels that were dropped
  int corrected = 0;                           ///< number of pixels whose wrap count was changed
};

struct FilterResult {
  RangeImage image;
  std::vector<FilterCount> counts;  ///< in the order of the chain
};

/// Applies the filters of `options.chain`, in that order. Each filter sees the image that the
/// previous filters left. A dropped pixel keeps the reason of the filter that dropped it. Throws
/// UsageError if a filter finds that `image`, `frame` and `rays` differ in size.
FilterResult apply_filters(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const FilterOptions& options);

}  // namespace tofmap
