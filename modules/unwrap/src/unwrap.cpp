// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/unwrap.hpp"

#include "confidence.hpp"
#include "counted_ranges.hpp"
#include "joint.hpp"
#include "measured_frame.hpp"
#include "tofmap/unwrap/beat.hpp"
#include "tofmap/unwrap/jump_integration.hpp"

#include <algorithm>

namespace tofmap {
namespace {

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
UnwrapResult unwrap_by_jumps(JumpEstimator& estimator, const MeasuredFrame& frame,
                             const BeatLimits& limits, const UnwrapOptions& options) {
  const bool two_frequencies = unwrap_method(options) == UnwrapMethod::jump;
  const JumpEstimate& jumps = estimator.estimate(frame.returns, frame.sigma, limits, options);
  const JumpBeliefs& beliefs = jumps.beliefs;
  const BeatCost beat = two_frequencies ? BeatCost(frame.returns, limits, frame.sigma) : BeatCost();
  const RelativeCounts relative =
      two_frequencies ? integrate_jumps_with_beat(beliefs.marginals, jumps.evidence, frame.valid,
                                                  beat, jumps.nearest, options.objection_share)
                      : integrate_jumps(beliefs.marginals, jumps.evidence, frame.valid);
  const ImageU8 counts = absolute_counts(relative, limits.count_a);
  const ImageF confidence = two_frequencies
                                ? jump_and_beat_confidence(counts, beliefs.marginals, beat)
                                : jump_confidence(counts, beliefs.marginals);

  UnwrapResult result;
  result.image =
      make_range_image(frame.returns.phase_a, frame.sigma.a_cycles, counts, confidence, limits);
  result.iterations = beliefs.iterations;
  result.curl_violations = beliefs.curl_violations;
  result.converged = beliefs.converged;
  result.largest_message_change = beliefs.largest_message_change;
  result.regions = relative.region_count;
  return result;
}

/// Every pixel by itself: its counts, as confident as the beat is of them.
UnwrapResult unwrap_by_pixel(const MeasuredFrame& frame, const ImageU8& counts,
                             const BeatLimits& limits) {
  const ImageF confidence = BeatCost(frame.returns, limits, frame.sigma).probability(counts);
  return {.image = make_range_image(frame.returns.phase_a, frame.sigma.a_cycles, counts, confidence,
                                    limits)};
}

/// Count 0 for all pixels with a return.
ImageU8 wrapped_counts(const ImageU8& valid) {
  return (valid != 0).select(ImageU8::Zero(valid.rows(), valid.cols()), invalid_wrap_count);
}

}  // namespace

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
  const MeasuredFrame measured(frame, saturation_amplitude_);
  const auto unwrap_measured = [&] {
    switch (method_) {
      case UnwrapMethod::joint:
        return unwrap_jointly(count_estimator_, measured, limits_, rays_, options_);
      case UnwrapMethod::jump:
      case UnwrapMethod::single:
        return unwrap_by_jumps(jump_estimator_, measured, limits_, options_);
      case UnwrapMethod::pixel:
        return unwrap_by_pixel(measured, nearest_pair_counts(measured.returns, limits_), limits_);
      case UnwrapMethod::none:
        break;
    }
    return unwrap_by_pixel(measured, wrapped_counts(measured.valid), limits_);
  };
  UnwrapResult result = unwrap_measured();
  const auto because_saturated = static_cast<std::uint8_t>(InvalidReason::saturated);
  result.image.reason = (measured.saturated != 0).select(because_saturated, result.image.reason);
  result.phase_noise_cycles = median_phase_noise_cycles(measured);
  return result;
}

UnwrapResult unwrap(const DualFrequencyFrame& frame, const SensorModel& sensor,
                    const UnwrapOptions& options) {
  return Unwrapper(sensor, options).unwrap(frame);
}

}  // namespace tofmap
