// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/unwrap.hpp"

#include "common/counted_ranges.hpp"
#include "joint/joint.hpp"
#include "jump/jump.hpp"
#include "tofmap/unwrap/common/residual_cost.hpp"

namespace tofmap {
namespace {

/// Ranges for the given wrap counts. The confidence of a pixel follows from its own residual alone.
UnwrapResult unwrap_by_pixel(const MeasuredFrame& frame, const ImageU8& counts,
                             const UnwrapLimits& limits) {
  const ImageF confidence = ResidualCost(frame.returns, limits, frame.sigma).probability(counts);
  return {.image = make_range_image(frame.returns.phase_a, frame.sigma.a_cycles, counts, confidence,
                                    limits)};
}

/// Wrap count 0 for all valid pixels.
ImageU8 wrapped_counts(const ImageU8& valid) {
  return (valid != 0).select(ImageU8::Zero(valid.rows(), valid.cols()), invalid_wrap_count);
}

}  // namespace

Unwrapper::Unwrapper(const SensorModel& sensor, const UnwrapOptions& options)
    : options_(options),
      method_(options.method),
      limits_(unwrap_limits(sensor, options.max_range_m)),
      measurer_(sensor, options) {}

UnwrapResult Unwrapper::unwrap(const DualFrequencyFrame& frame) {
  return unwrap(measurer_.measure(frame));
}

UnwrapResult Unwrapper::unwrap(const MeasuredFrame& measured) {
  const auto unwrap_measured = [&] {
    switch (method_) {
      case UnwrapMethod::joint:
        return unwrap_jointly(count_estimator_, measured, limits_, options_);
      case UnwrapMethod::jump:
      case UnwrapMethod::paper:
      case UnwrapMethod::single:
        return unwrap_by_jumps(jump_estimator_, measured, limits_, jump_method(method_), options_);
      case UnwrapMethod::pixel:
        return unwrap_by_pixel(measured, nearest_pair_counts(measured.returns, limits_), limits_);
      case UnwrapMethod::none:
        break;
    }
    return unwrap_by_pixel(measured, wrapped_counts(measured.valid), limits_);
  };
  UnwrapResult result = unwrap_measured();
  result.errors = measured.errors;
  result.image.systematic_m = range_systematic_m(measured.errors.camera);
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
