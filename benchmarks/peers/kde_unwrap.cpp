// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/kde_unwrap.hpp"

#include "peers/kernel_density.hpp"
#include "peers/range_hypotheses.hpp"
#include "peers/wrap_triplets.hpp"

#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap::peers {
namespace {

void require_positive(std::string_view name, double value) {
  if (!(value > 0)) throw UsageError(fmt::format("{} is {}, but must be positive", name, value));
}

void check(const KdeOptions& options) {
  if (options.hypotheses != 2 && options.hypotheses != 3)
    throw UsageError(fmt::format("hypotheses is {}, but must be 2 or 3", options.hypotheses));
  if (options.support_radius_px < 0)
    throw UsageError(
        fmt::format("support_radius_px is {}, but must be 0 or more", options.support_radius_px));
  require_positive("unwrapping_scale", options.unwrapping_scale);
  require_positive("phase_scale_rad2", options.phase_scale_rad2);
  require_positive("kernel_bandwidth_m", options.kernel_bandwidth_m);
  require_positive("spatial_sigma_px", options.spatial_sigma_px);
  require_positive("least_total_weight", options.least_total_weight);
  require_positive("max_range_m", options.max_range_m);
}

/// The hypothesis of a pixel with the largest density, the better one of equals.
std::size_t densest(const std::array<ImageF, most_hypotheses>& density, int hypotheses,
                    Eigen::Index v, Eigen::Index u) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(hypotheses); ++i)
    if (density[i](v, u) > density[best](v, u)) best = i;
  return best;
}

}  // namespace

KdeResult kde_unwrap(const ThreePhases& measured, const KdeOptions& options) {
  check(options);
  ThreePhases phases = calibrated(measured, options.camera);
  if (options.smooth) phases = smooth_phases(phases, options.smoothing).phases;
  const WrapTriplets triplets =
      wrap_triplets(phases.frequencies_hz, options.camera.speed_of_light_m_s);
  const RangeHypotheses hypotheses = range_hypotheses(phases, triplets, options);
  const auto density = kernel_densities(hypotheses, options.support_radius_px,
                                        options.spatial_sigma_px, options.least_total_weight);

  KdeResult result;
  result.range_m = ImageF::Constant(phases.rows(), phases.cols(), nan);
  result.confidence = ImageF::Zero(phases.rows(), phases.cols());
  result.wrap_count = ImageU8::Constant(phases.rows(), phases.cols(), no_wrap_count);
  const auto unit_m = static_cast<float>(std::numbers::sqrt2 * options.kernel_bandwidth_m);
  const auto min_range_m = static_cast<float>(options.min_range_m);
  const auto max_range_m = static_cast<float>(options.max_range_m);
  const auto min_confidence = static_cast<float>(options.min_confidence);
  for (Eigen::Index v = 0; v < phases.rows(); ++v) {
    for (Eigen::Index u = 0; u < phases.cols(); ++u) {
      if (std::isnan(phases.phase_cycles[0](v, u))) continue;
      const Eigen::Index padded_u = u + hypotheses.margin;
      const std::size_t i = densest(density, hypotheses.count, v, padded_u);
      const float range_m = hypotheses.range[i](v, padded_u) * unit_m;
      const bool within = range_m >= min_range_m && range_m <= max_range_m;
      const float confidence = within ? density[i](v, padded_u) : 0.0F;
      result.confidence(v, u) = confidence;
      const auto triplet = static_cast<std::size_t>(hypotheses.triplet[i](v, u));
      result.wrap_count(v, u) = triplets.triplets[triplet][0];
      if (confidence >= min_confidence) result.range_m(v, u) = range_m;
    }
  }
  return result;
}

}  // namespace tofmap::peers
