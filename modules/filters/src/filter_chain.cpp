// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/filter_chain.hpp"

#include "tofmap/filters/gates.hpp"
#include "tofmap/filters/jump_edge_filter.hpp"
#include "tofmap/filters/outlier_filter.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

/// What filters use besides the ranges.
struct FilterInput {
  const Frame& frame;
  const Modulation& modulation;
  const PixelRays& rays;
  const FilterOptions& options;
};

struct FilterStep {
  NamedValue<Filter> filter;
  InvalidReason reason;  ///< of the pixels that it drops; none if it drops nothing
  RangeImage (*apply)(const RangeImage&, const FilterInput&);
};

constexpr std::array<FilterStep, 9> all_filters{
    {{{"amplitude", Filter::amplitude},
      InvalidReason::low_amplitude,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_low_amplitude(image, in.frame, in.options.min_amplitude);
      }},
     {{"confidence", Filter::confidence},
      InvalidReason::low_confidence,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_low_confidence(image, in.options.min_confidence);
      }},
     {{"phasor_mean", Filter::phasor_mean},
      InvalidReason::none,
      [](const RangeImage& image, const FilterInput& in) {
        return average_phasors(image, in.frame, in.modulation, in.rays,
                               {.min_noise_cycles = in.options.min_phasor_noise_cycles,
                                .max_radius_px = in.options.max_phasor_radius_px});
      }},
     {{"isolated_wrap", Filter::isolated_wrap},
      InvalidReason::isolated_wrap,
      [](const RangeImage& image, const FilterInput& in) {
        return mend_isolated_wraps(image, in.frame, in.modulation,
                                   {.max_share = in.options.max_isolated_share});
      }},
     {{"jump_edge", Filter::jump_edge},
      InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_jump_edges(image, in.rays, in.options.max_edge_angle_deg * rad_per_deg,
                               in.options.min_edge_gap_sigmas);
      }},
     {{"step_edge", Filter::step_edge},
      InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_steps(image, in.rays,
                          {.max_incidence_deg = in.options.max_step_incidence_deg,
                           .min_sigmas = in.options.min_step_sigmas});
      }},
     {{"plane_edge", Filter::plane_edge},
      InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_off_planes(image, in.frame, in.modulation, in.rays,
                               {.max_sigmas = in.options.max_plane_sigmas,
                                .max_edge_sigmas = in.options.max_edge_sigmas,
                                .tolerance_m = in.options.plane_tolerance_m});
      }},
     {{"outlier", Filter::outlier},
      InvalidReason::outlier,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_outliers(image, in.rays, in.options.max_outlier_deviations);
      }},
     {{"smooth", Filter::smooth},
      InvalidReason::none,
      [](const RangeImage& image, const FilterInput& in) {
        return smooth_ranges(image, in.rays,
                             {.max_sigmas = in.options.max_smooth_sigmas,
                              .tolerance_m = in.options.smooth_tolerance_m});
      }}}};

/// Throws UsageError for a value that is no filter.
const FilterStep& step_of(Filter filter) {
  for (const FilterStep& step : all_filters) {
    if (step.filter.value == filter) return step;
  }
  throw UsageError("filter chain: " + std::to_string(static_cast<int>(filter)) +
                   " is not a filter");
}

/// The number of pixels that are valid after filtering and have another wrap count than before.
int count_corrected(const RangeImage& before, const RangeImage& after) {
  return static_cast<int>((after.reason == 0 && before.wrap_count != after.wrap_count).count());
}

}  // namespace

std::span<const NamedValue<Filter>> named_values(Filter) {
  static const std::vector<NamedValue<Filter>> names = [] {
    std::vector<NamedValue<Filter>> all;
    for (const FilterStep& step : all_filters) all.push_back(step.filter);
    return all;
  }();
  return names;
}

std::vector<OptionField<FilterOptions>> FilterOptions::fields() {
  using O = FilterOptions;
  return {
      {"chain", &O::chain, 0, 0, "", "the filters in the order in which they run; empty: none"},
      {"min_amplitude", &O::min_amplitude, 0, 1e9, "",
       "amplitude: drops pixels with a weaker signal; in the units of the camera"},
      {"min_confidence", &O::min_confidence, 0, 1, "",
       "confidence: drops pixels with a lower confidence"},
      {"min_phasor_noise_cycles", &O::min_phasor_noise_cycles, 0, 1, "",
       "phasor_mean: averages only pixels with more range noise, as a fraction of A's wavelength"},
      {"max_phasor_radius_px", &O::max_phasor_radius_px, 0, 64, "px",
       "phasor_mean: largest radius of the averaging windows; below 2, nothing is averaged"},
      {"max_isolated_share", &O::max_isolated_share, 0, 1, "",
       "isolated_wrap: leaves regions alone that are a larger fraction of the image"},
      {"max_edge_angle_deg", &O::max_edge_angle_deg, 90, 180, "deg",
       "jump_edge: drops a pixel if the angle at its point, between the lines to the camera and to "
       "a neighbour, is larger"},
      {"min_edge_gap_sigmas", &O::min_edge_gap_sigmas, 0, 100, "",
       "jump_edge: ignores neighbours that are closer than this many standard deviations"},
      {"max_step_incidence_deg", &O::max_step_incidence_deg, 0, 89.9, "deg",
       "step_edge: angle of incidence of the steepest surface that is not taken for a step"},
      {"min_step_sigmas", &O::min_step_sigmas, 0, 100, "",
       "step_edge: standard deviations that are added to the smallest height of a step"},
      {"max_plane_sigmas", &O::max_plane_sigmas, 0, 100, "",
       "plane_edge: drops pixels that lie more standard deviations off the planes around them"},
      {"max_edge_sigmas", &O::max_edge_sigmas, 0, 100, "",
       "plane_edge: the same limit as max_plane_sigmas for pixels at a step between two surfaces"},
      {"plane_tolerance_m", &O::plane_tolerance_m, 0, 10, "m",
       "plane_edge: deviation from a plane that is always accepted"},
      {"max_smooth_sigmas", &O::max_smooth_sigmas, 0, 100, "",
       "smooth: averages only pixels that differ by fewer standard deviations"},
      {"smooth_tolerance_m", &O::smooth_tolerance_m, 0, 10, "m",
       "smooth: difference in depth that is always accepted"},
      {"max_outlier_deviations", &O::max_outlier_deviations, 0, 1000, "",
       "outlier: drops points whose spacing exceeds the median by more standard deviations"},
  };
}

std::vector<Filter> smoothing_chain() {
  std::vector<Filter> chain = FilterOptions{}.chain;
  chain.push_back(Filter::smooth);
  return chain;
}

FilterResult apply_filters(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const FilterOptions& options) {
  FilterResult result;
  result.image = image;
  for (const Filter filter : options.chain) {
    const FilterStep& step = step_of(filter);
    RangeImage filtered = step.apply(result.image, {frame, modulation, rays, options});
    result.counts.push_back({.filter = filter,
                             .reason = step.reason,
                             .removed = result.image.count_valid() - filtered.count_valid(),
                             .corrected = count_corrected(result.image, filtered)});
    result.image = std::move(filtered);
  }
  return result;
}

}  // namespace tofmap
