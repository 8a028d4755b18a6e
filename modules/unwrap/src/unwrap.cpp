// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/unwrap.hpp"

#include "confidence.hpp"
#include "counted_ranges.hpp"
#include "joint.hpp"
#include "median.hpp"
#include "tofmap/unwrap/beat.hpp"
#include "tofmap/unwrap/jump_estimate.hpp"
#include "tofmap/unwrap/jump_integration.hpp"
#include "tofmap/unwrap/phase_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

struct NamedMethod {
  std::string_view name;
  UnwrapMethod method;
};

constexpr std::array<NamedMethod, 5> methods{{{"joint", UnwrapMethod::joint},
                                              {"jump", UnwrapMethod::jump},
                                              {"single", UnwrapMethod::single},
                                              {"pixel", UnwrapMethod::pixel},
                                              {"none", UnwrapMethod::none}}};

void check(const DualFrequencyFrame& frame) {
  const bool agree = same_size(frame.phase_a, frame.phase_b) &&
                     (!frame.has_amplitude() || (same_size(frame.phase_a, frame.amplitude_a) &&
                                                 same_size(frame.phase_a, frame.amplitude_b)));
  if (!agree) {
    throw UsageError("unwrap: frame " + std::to_string(frame.index) +
                     ": images differ in size; phases and amplitudes must have one size, or "
                     "amplitudes be empty");
  }
}

/// Not 0 where the signal is too strong at one of the frequencies.
ImageU8 saturated_pixels(const DualFrequencyFrame& frame, double saturation_amplitude) {
  if (!(saturation_amplitude > 0) || !frame.has_amplitude()) {
    return ImageU8::Zero(frame.phase_a.rows(), frame.phase_a.cols());
  }
  const auto limit = static_cast<float>(saturation_amplitude);
  return (frame.amplitude_a >= limit || frame.amplitude_b >= limit).cast<std::uint8_t>();
}

/// Not 0 where both frequencies have a return (and a positive amplitude, if there is one).
ImageU8 pixels_with_return(const DualFrequencyFrame& frame) {
  ImageU8 valid = (frame.phase_a.isFinite() && frame.phase_b.isFinite()).cast<std::uint8_t>();
  if (frame.has_amplitude()) {
    valid *= (frame.amplitude_a > 0 && frame.amplitude_b > 0).cast<std::uint8_t>();
  }
  return valid;
}

/// The frame with NaN phases wherever a return is missing, so that no stage asks again.
DualFrequencyFrame with_returns_only(const DualFrequencyFrame& frame, const ImageU8& valid) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  DualFrequencyFrame out = frame;
  out.phase_a = (valid != 0).select(frame.phase_a, nan);
  out.phase_b = (valid != 0).select(frame.phase_b, nan);
  return out;
}

/// Counts as anchored, kept within what the scene can hold; invalid where there is no region.
ImageU8 absolute_counts(const RelativeCounts& relative, int count_a) {
  ImageU8 counts =
      ImageU8::Constant(relative.count.rows(), relative.count.cols(), invalid_wrap_count);
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    const int region = relative.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    const int n = relative.count.data()[i] + relative.anchor[static_cast<std::size_t>(region)];
    counts.data()[i] = static_cast<std::uint8_t>(std::clamp(n, 0, count_a - 1));
  }
  return counts;
}

/// The paper: evidence, propagation, integration, anchors.
UnwrapResult unwrap_by_jumps(JumpPropagation& propagation, const DualFrequencyFrame& frame,
                             const ImageU8& valid, const BeatLimits& limits,
                             const PhaseNoise& noise, const UnwrapOptions& options) {
  const bool two_frequencies = unwrap_method(options) == UnwrapMethod::jump;
  const JumpEstimate jumps = estimate_jumps(propagation, frame, limits, noise, options);
  const JumpBeliefs& beliefs = jumps.beliefs;
  const BeatCost beat = two_frequencies ? BeatCost(frame, limits, noise) : BeatCost();
  const RelativeCounts relative =
      two_frequencies ? integrate_jumps_with_beat(beliefs.marginals, jumps.evidence, valid, beat,
                                                  jumps.nearest, options.objection_share)
                      : integrate_jumps(beliefs.marginals, jumps.evidence, valid);
  const ImageU8 counts = absolute_counts(relative, limits.count_a);
  const ImageF confidence = two_frequencies
                                ? jump_and_beat_confidence(counts, beliefs.marginals, beat)
                                : jump_confidence(counts, beliefs.marginals);

  UnwrapResult result;
  result.image = make_range_image(frame, counts, confidence, limits, noise);
  result.iterations = beliefs.iterations;
  result.curl_violations = beliefs.curl_violations;
  result.converged = beliefs.converged;
  result.largest_message_change = beliefs.largest_message_change;
  result.regions = relative.region_count;
  return result;
}

UnwrapResult unwrap_by_pixel(const DualFrequencyFrame& frame, const BeatLimits& limits,
                             const PhaseNoise& noise) {
  const ImageU8 counts = nearest_pair_counts(frame, limits);
  const ImageF confidence = BeatCost(frame, limits, noise).probability(counts);
  return {.image = make_range_image(frame, counts, confidence, limits, noise)};
}

/// Count 0, as confident as the beat is of that.
UnwrapResult leave_wrapped(const DualFrequencyFrame& frame, const ImageU8& valid,
                           const BeatLimits& limits, const PhaseNoise& noise) {
  const ImageU8 counts =
      (valid != 0).select(ImageU8::Zero(valid.rows(), valid.cols()), invalid_wrap_count);
  const ImageF confidence = BeatCost(frame, limits, noise).probability(counts);
  return {.image = make_range_image(frame, counts, confidence, limits, noise)};
}

double median_phase_noise_cycles(const DualFrequencyFrame& frame, const PhaseNoise& noise) {
  const ImageF sigma = phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a);
  std::vector<float> sigmas;
  sigmas.reserve(static_cast<std::size_t>(sigma.size()));
  std::copy_if(sigma.data(), sigma.data() + sigma.size(), std::back_inserter(sigmas),
               [](float s) { return std::isfinite(s); });
  return sigmas.empty() ? 0 : median_of_positive(sigmas);
}

}  // namespace

std::vector<OptionField<UnwrapOptions>> UnwrapOptions::fields() {
  static const std::string method_choices = unwrap_method_names(" | ");
  using O = UnwrapOptions;
  return {
      {"method", &O::method, 0, 0, "", "how wraps are found", method_choices},
      {"max_range_m", &O::max_range_m, 0, 100000, "m",
       "farthest range that the scene can hold; 0: the recording's, else what the pair can tell "
       "apart"},
      {"count_iterations", &O::count_iterations, 1, 1000, "",
       "joint: iterations of belief propagation over counts"},
      {"scales", &O::scales, 1, 6, "",
       "joint: pixels, blocks of 2 x 2, of 4 x 4 ... where noise asks for it; 1: pixels alone"},
      {"outlier_share", &O::outlier_share, 1e-6, 0.99, "",
       "joint: share of a pixel's evidence that may come from no surface at all"},
      {"slope_m", &O::slope_m, 0.001, 10, "m",
       "joint: typical difference of true ranges between neighbours on a surface"},
      {"amplitude_edges", &O::amplitude_edges, 0, 1, "",
       "joint: a change of amplitude makes an edge likelier"},
      {"mixed_pixels", &O::mixed_pixels, 0, 1, "",
       "joint: a pixel with an amplitude between those of opposite neighbours has two surfaces, "
       "and "
       "is left to them"},
      {"fuse_frequencies", &O::fuse_frequencies, 0, 1, "",
       "joint: ranges from both frequencies, weighted by their noise, not from A alone"},
      {"correct_exposure", &O::correct_exposure, 0, 1, "",
       "joint: allow for the camera's motion from A's exposure to B's when ranges are fused"},
      {"iterations", &O::iterations, 1, 1000, "",
       "jump, single: most iterations of belief propagation"},
      {"trust_discontinuity", &O::trust_discontinuity, 0, 1, "",
       "jump, single: c_d, trust in phases of neighbours being close"},
      {"trust_frequency", &O::trust_frequency, 0, 1, "",
       "jump: c_f, trust in the difference of the two frequencies"},
      {"window_px", &O::window_px, 1, 99, "px",
       "jump: k, pixels on each side of a jump in the medians"},
      {"sigma_cycles", &O::sigma_cycles, 0.001, 10, "cycles",
       "jump, single: sigma of f_d and f_f: of true differences between neighbours; noise comes on "
       "top"},
      {"objection_share", &O::objection_share, 0, 1e6, "",
       "jump: regions stay apart where the beat objects by more than this share of a jump's log "
       "odds"},
  };
}

std::string unwrap_method_names(const std::string& separator) {
  std::string names;
  for (const NamedMethod& named : methods) {
    names += (names.empty() ? "" : separator) + std::string(named.name);
  }
  return names;
}

std::optional<UnwrapMethod> find_unwrap_method(std::string_view name) {
  for (const NamedMethod& named : methods) {
    if (name == named.name) return named.method;
  }
  return std::nullopt;
}

UnwrapMethod unwrap_method(const UnwrapOptions& options) {
  if (const auto method = find_unwrap_method(options.method)) return *method;
  throw UsageError("option unwrap.method: '" + options.method +
                   "' is not allowed; allowed: " + unwrap_method_names(" | "));
}

Unwrapper::Unwrapper(const SensorModel& sensor, const UnwrapOptions& options)
    : options_(options),
      method_(unwrap_method(options)),
      limits_(beat_limits(sensor, options.max_range_m)),
      saturation_amplitude_(sensor.saturation_amplitude) {
  const bool knows_camera = sensor.camera.width_px > 0 && sensor.camera.fx_px > 0;
  const bool needs_rays =
      method_ == UnwrapMethod::joint && options.fuse_frequencies && options.correct_exposure;
  if (knows_camera && needs_rays) rays_ = pixel_rays(sensor.camera);
}

UnwrapResult Unwrapper::unwrap(const DualFrequencyFrame& frame) {
  check(frame);
  const ImageU8 returned = pixels_with_return(frame);
  const ImageU8 saturated = saturated_pixels(frame, saturation_amplitude_);
  const ImageU8 valid = (saturated == 0).select(returned, std::uint8_t{0});
  const DualFrequencyFrame returns = with_returns_only(frame, valid);
  const PhaseNoise noise = estimate_phase_noise(returns);
  const auto unwrap_returns = [&] {
    switch (method_) {
      case UnwrapMethod::joint:
        return unwrap_jointly(estimator_, returns, limits_, noise, rays_, options_);
      case UnwrapMethod::jump:
      case UnwrapMethod::single:
        return unwrap_by_jumps(propagation_, returns, valid, limits_, noise, options_);
      case UnwrapMethod::pixel:
        return unwrap_by_pixel(returns, limits_, noise);
      case UnwrapMethod::none:
        break;
    }
    return leave_wrapped(returns, valid, limits_, noise);
  };
  UnwrapResult result = unwrap_returns();
  const auto because_saturated = static_cast<std::uint8_t>(InvalidReason::saturated);
  result.image.reason =
      (returned != 0 && saturated != 0).select(because_saturated, result.image.reason);
  result.phase_noise_cycles = median_phase_noise_cycles(returns, noise);
  return result;
}

UnwrapResult unwrap(const DualFrequencyFrame& frame, const SensorModel& sensor,
                    const UnwrapOptions& options) {
  return Unwrapper(sensor, options).unwrap(frame);
}

}  // namespace tofmap
