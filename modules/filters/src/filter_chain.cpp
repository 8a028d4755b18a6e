// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/filter_chain.hpp"

#include "tofmap/filters/gates.hpp"
#include "tofmap/filters/isolated_wrap_filter.hpp"
#include "tofmap/filters/jump_edge_filter.hpp"
#include "tofmap/filters/outlier_filter.hpp"
#include "tofmap/filters/phasor_mean_filter.hpp"
#include "tofmap/filters/plane_edge_filter.hpp"
#include "tofmap/filters/smooth_filter.hpp"
#include "tofmap/filters/step_edge_filter.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <ranges>
#include <sstream>
#include <string_view>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;

/// What filters know of a frame besides its ranges.
struct FilterInput {
  const DualFrequencyFrame& frame;
  const Modulation& modulation;
  const PixelRays& rays;
  const FilterOptions& options;
};

struct NamedFilter {
  std::string_view name;
  InvalidReason reason;  ///< of what it drops; none if it drops nothing
  RangeImage (*apply)(const RangeImage&, const FilterInput&);
};

constexpr std::array<NamedFilter, 9> all_filters{
    {{"amplitude", InvalidReason::low_amplitude,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_low_amplitude(image, in.frame, in.options.min_amplitude);
      }},
     {"confidence", InvalidReason::low_confidence,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_low_confidence(image, in.options.min_confidence);
      }},
     {"phasor_mean", InvalidReason::none,
      [](const RangeImage& image, const FilterInput& in) {
        return average_phasors(image, in.frame, in.modulation, in.rays,
                               {.min_noise_cycles = in.options.min_phasor_noise_cycles,
                                .max_radius_px = in.options.max_phasor_radius_px});
      }},
     {"isolated_wrap", InvalidReason::isolated_wrap,
      [](const RangeImage& image, const FilterInput& in) {
        return mend_isolated_wraps(image, in.frame, in.modulation,
                                   {.max_share = in.options.max_isolated_share});
      }},
     {"jump_edge", InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_jump_edges(image, in.rays, in.options.max_edge_angle_deg * rad_per_deg,
                               in.options.min_edge_gap_sigmas);
      }},
     {"step_edge", InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_steps(image, in.rays,
                          {.max_incidence_rad = in.options.max_step_incidence_deg * rad_per_deg,
                           .min_sigmas = in.options.min_step_sigmas});
      }},
     {"plane_edge", InvalidReason::jump_edge,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_off_planes(image, in.frame, in.modulation, in.rays,
                               {.max_sigmas = in.options.max_plane_sigmas,
                                .max_edge_sigmas = in.options.max_edge_sigmas,
                                .tolerance_m = in.options.plane_tolerance_m});
      }},
     {"outlier", InvalidReason::outlier,
      [](const RangeImage& image, const FilterInput& in) {
        return drop_outliers(image, in.rays, in.options.max_outlier_deviations);
      }},
     {"smooth", InvalidReason::none, [](const RangeImage& image, const FilterInput& in) {
        return smooth_ranges(image, in.rays,
                             {.max_sigmas = in.options.max_smooth_sigmas,
                              .tolerance_m = in.options.smooth_tolerance_m});
      }}}};

const NamedFilter& find_filter(const std::string& name) {
  const auto* found = std::ranges::find(all_filters, name, &NamedFilter::name);
  if (found != all_filters.end()) return *found;
  throw UsageError("option filters.chain: '" + name +
                   "' is no filter; allowed: " + filter_names(", "));
}

/// Pixels that are valid in both with different wrap counts.
int count_corrected(const RangeImage& before, const RangeImage& after) {
  return static_cast<int>((after.reason == 0 && before.wrap_count != after.wrap_count).count());
}

}  // namespace

std::vector<OptionField<FilterOptions>> FilterOptions::fields() {
  using O = FilterOptions;
  static const std::string chain_meaning =
      "names of the filters, in their order: " + filter_names(", ");
  return {
      {"chain", &O::chain, 0, 0, "", chain_meaning},
      {"min_amplitude", &O::min_amplitude, 0, 1e9, "",
       "amplitude: pixels with a weaker signal are dropped; in the camera's units"},
      {"min_confidence", &O::min_confidence, 0, 1, "",
       "confidence: pixels less sure than this are dropped"},
      {"min_phasor_noise_cycles", &O::min_phasor_noise_cycles, 0, 1, "",
       "phasor_mean: pixels with less noise, as a share of A's wavelength, are left alone"},
      {"max_phasor_radius_px", &O::max_phasor_radius_px, 0, 64, "px",
       "phasor_mean: windows grow no farther; 0 turns it off"},
      {"max_isolated_share", &O::max_isolated_share, 0, 1, "",
       "isolated_wrap: regions of a larger share of the image are left alone"},
      {"max_edge_angle_deg", &O::max_edge_angle_deg, 90, 180, "deg",
       "jump_edge: a pixel with a neighbour this straight behind it is a flying one"},
      {"min_edge_gap_sigmas", &O::min_edge_gap_sigmas, 0, 100, "",
       "jump_edge: neighbours closer than this many standard deviations of the noise are no edge"},
      {"max_step_incidence_deg", &O::max_step_incidence_deg, 0, 89.9, "deg",
       "step_edge: surfaces seen at more than this look like steps"},
      {"min_step_sigmas", &O::min_step_sigmas, 0, 100, "",
       "step_edge: steps below this many standard deviations of the noise are none"},
      {"max_plane_sigmas", &O::max_plane_sigmas, 0, 100, "",
       "plane_edge: pixels off the planes around them by more standard deviations are dropped"},
      {"max_edge_sigmas", &O::max_edge_sigmas, 0, 100, "",
       "plane_edge: the same at a step between two surfaces"},
      {"plane_tolerance_m", &O::plane_tolerance_m, 0, 10, "m",
       "plane_edge: but not if they are no farther off than this"},
      {"max_smooth_sigmas", &O::max_smooth_sigmas, 0, 100, "",
       "smooth: pixels that differ by more standard deviations are not averaged"},
      {"smooth_tolerance_m", &O::smooth_tolerance_m, 0, 10, "m",
       "smooth: unless they differ by less than this"},
      {"max_outlier_deviations", &O::max_outlier_deviations, 0, 1000, "",
       "outlier: points that much farther from those around them than most are dropped, in "
       "standard "
       "deviations"},
  };
}

std::string smoothing_chain() { return FilterOptions{}.chain + " smooth"; }

std::string filter_names(const std::string& separator) {
  return joined(std::views::transform(all_filters, &NamedFilter::name), separator);
}

FilterResult apply_filters(const RangeImage& image, const DualFrequencyFrame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const FilterOptions& options) {
  FilterResult result;
  result.image = image;
  std::istringstream names(options.chain);
  for (std::string name; names >> name;) {
    const NamedFilter& filter = find_filter(name);
    RangeImage filtered = filter.apply(result.image, {frame, modulation, rays, options});
    result.counts.push_back({.name = name,
                             .reason = filter.reason,
                             .removed = result.image.count_valid() - filtered.count_valid(),
                             .corrected = count_corrected(result.image, filtered)});
    result.image = std::move(filtered);
  }
  return result;
}

}  // namespace tofmap
