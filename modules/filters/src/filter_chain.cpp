// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/filter_chain.hpp"

#include "tofmap/filters/gates.hpp"
#include "tofmap/filters/jump_edge_filter.hpp"

#include <numbers>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

struct FilterStep {
  RangeImage image;
  InvalidReason reason;
};

FilterStep apply_filter(const std::string& name, const RangeImage& image,
                        const DualFrequencyFrame& frame, const PixelRays& rays,
                        const FilterOptions& options) {
  if (name == "amplitude") {
    return {drop_low_amplitude(image, frame, options.min_amplitude), InvalidReason::low_amplitude};
  }
  if (name == "confidence") {
    return {drop_low_confidence(image, options.min_confidence), InvalidReason::low_confidence};
  }
  if (name == "jump_edge") {
    const double max_angle_rad = options.max_edge_angle_deg * std::numbers::pi / 180;
    return {drop_jump_edges(image, rays, max_angle_rad, options.min_edge_gap_sigmas),
            InvalidReason::jump_edge};
  }
  throw UsageError("option filters.chain: '" + name +
                   "' is no filter; allowed: amplitude, confidence, jump_edge");
}

}  // namespace

std::vector<OptionField<FilterOptions>> FilterOptions::fields() {
  using O = FilterOptions;
  return {
      {"chain", &O::chain, 0, 0, "",
       "names of the filters, in their order: amplitude, confidence, jump_edge"},
      {"min_amplitude", &O::min_amplitude, 0, 1e9, "",
       "pixels with a weaker signal are dropped; in the camera's units"},
      {"min_confidence", &O::min_confidence, 0, 1, "", "pixels less sure than this are dropped"},
      {"max_edge_angle_deg", &O::max_edge_angle_deg, 90, 180, "deg",
       "a pixel with a neighbour this straight behind it is a flying one"},
      {"min_edge_gap_sigmas", &O::min_edge_gap_sigmas, 0, 100, "",
       "neighbours closer than this many standard deviations of the noise are no edge"},
  };
}

FilterResult apply_filters(const RangeImage& image, const DualFrequencyFrame& frame,
                           const PixelRays& rays, const FilterOptions& options) {
  FilterResult result;
  result.image = image;
  std::istringstream names(options.chain);
  for (std::string name; names >> name;) {
    const int before = result.image.count_valid();
    FilterStep step = apply_filter(name, result.image, frame, rays, options);
    result.image = std::move(step.image);
    result.counts.push_back({name, step.reason, before - result.image.count_valid()});
  }
  return result;
}

}  // namespace tofmap
