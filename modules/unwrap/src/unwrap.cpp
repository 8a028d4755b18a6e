// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/unwrap.hpp"

#include "common/counted_ranges.hpp"
#include "common/frequency_order.hpp"
#include "common/pixel_counts.hpp"
#include "joint/joint.hpp"
#include "jump/jump.hpp"

#include <cmath>
#include <string>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Ranges for the given wrap counts. The confidence of a pixel follows from its own residuals
/// alone.
UnwrapResult unwrap_by_pixel(const MeasuredFrame& frame, const ImageU8& counts,
                             const UnwrapLimits& limits) {
  const ImageF confidence = count_probability(frame.returns, counts, limits, frame.sigma);
  return {.image = make_range_image(frame.returns.phases[0], frame.sigma.cycles[0], counts,
                                    confidence, limits.wavelength_m())};
}

/// Wrap count 0 for all valid pixels.
ImageU8 wrapped_counts(const ImageU8& valid) {
  return (valid != 0).select(ImageU8::Zero(valid.rows(), valid.cols()), invalid_wrap_count);
}

/// The measurements of the frequencies `order` alone, with residuals to its first one.
MeasuredFrame in_order(const MeasuredFrame& frame, const std::vector<std::size_t>& order) {
  MeasuredFrame out;
  out.valid = frame.valid;
  out.saturated = frame.saturated;
  out.ambient = frame.ambient;
  out.returns = with_frequencies(frame.returns, order);
  const std::size_t first = order.front();
  for (const std::size_t f : order) {
    out.noise.push_back(frame.noise[f]);
    out.sigma.cycles.push_back(frame.sigma.cycles[f]);
    out.errors.push_back(frame.errors[f]);
    // The residuals of both frequencies are those to the first one of the recording.
    out.residual_sigma_m.push_back(
        f == first ? 0 : std::hypot(frame.residual_sigma_m[first], frame.residual_sigma_m[f]));
  }
  return out;
}

/// The standard deviation of the systematic error of a range, from those of all frequencies.
double systematic_error_m(const std::vector<FrameErrors>& errors) {
  double sum_m2 = 0;
  for (std::size_t f = 1; f < errors.size(); ++f) {
    const double systematic_m = range_systematic_m(errors[f].camera);
    sum_m2 += systematic_m * systematic_m;
  }
  return errors.size() > 1 ? std::sqrt(sum_m2 / static_cast<double>(errors.size() - 1)) : 0;
}

}  // namespace

Unwrapper::Unwrapper(const SensorModel& sensor, const UnwrapOptions& options)
    : options_(options),
      method_(options.method),
      limits_(unwrap_limits(sensor, options.max_range_m)),
      counting_order_(counting_order(limits_)),
      measurer_(sensor, options) {
  if (!finds_jumps(method_)) return;
  pair_ = compared_pair(options, sensor.modulation);
  pair_limits_ = pair_limits(pair_, sensor.modulation, limits_);
}

UnwrapResult Unwrapper::unwrap(const Frame& frame) { return unwrap(measurer_.measure(frame)); }

UnwrapResult Unwrapper::unwrap_pair(const MeasuredFrame& measured) {
  const JumpMethod method = jump_method(method_);
  const bool has_others = limits_.frequencies() > 2 || pair_.a > 0;
  if (!has_others) {
    return unwrap_by_jumps(jump_estimator_, measured, pair_limits_, method, options_);
  }
  std::vector<std::size_t> order = {pair_.a};
  if (pair_.b) order.push_back(*pair_.b);
  UnwrapResult result =
      unwrap_by_jumps(jump_estimator_, in_order(measured, order), pair_limits_, method, options_);
  if (pair_.a > 0) {
    count_at_ranges(measured.returns.phases.front(), limits_.wavelength_m(), result.image);
  }
  return result;
}

/// By `joint`. Where another frequency than the first one is counted, the wrap counts of the first
/// one follow from the ranges.
UnwrapResult Unwrapper::unwrap_counted(const MeasuredFrame& measured) {
  if (counting_order_.front() == 0) {
    return unwrap_jointly(count_estimator_, measured, limits_, options_);
  }
  UnwrapResult result = unwrap_jointly(count_estimator_, in_order(measured, counting_order_),
                                       in_order(limits_, counting_order_), options_);
  RangeImage& image = result.image;
  const ImageF& phase = measured.returns.phases.front();
  count_at_ranges(phase, limits_.wavelength_m(), image);
  if (!options_.fuse_frequencies) {
    // Pixels keep their reason and confidence.
    const RangeImage by_first =
        make_range_image(phase, measured.sigma.cycles.front(), image.wrap_count, image.confidence,
                         limits_.wavelength_m());
    image.range_m = by_first.range_m;
    image.sigma_m = by_first.sigma_m;
  }
  return result;
}

/// The wrap counts of a single frequency relative to the nearest pixel of each region. The absolute
/// wrap counts may be any of those within the limits, so the confidence is divided by their number.
UnwrapResult Unwrapper::unwrap_relative(const MeasuredFrame& measured) {
  UnwrapResult result = unwrap_by_jumps(jump_estimator_, measured, limits_.pair(0, 1),
                                        jump_method(UnwrapMethod::single), options_);
  result.image.confidence /= static_cast<float>(limits_.count);
  return result;
}

UnwrapResult Unwrapper::unwrap(const MeasuredFrame& measured) {
  const bool is_relative = limits_.frequencies() == 1;
  const auto unwrap_measured = [&] {
    switch (method_) {
      case UnwrapMethod::joint:
        if (is_relative) return unwrap_relative(measured);
        return unwrap_counted(measured);
      case UnwrapMethod::jump:
      case UnwrapMethod::paper:
      case UnwrapMethod::single:
        return is_relative ? unwrap_relative(measured) : unwrap_pair(measured);
      case UnwrapMethod::pixel:
        return unwrap_by_pixel(measured, nearest_counts(measured.returns, limits_, measured.sigma),
                               limits_);
      case UnwrapMethod::none:
        break;
    }
    return unwrap_by_pixel(measured, wrapped_counts(measured.valid), limits_);
  };
  UnwrapResult result = unwrap_measured();
  result.errors = measured.errors;
  result.image.systematic_m = systematic_error_m(measured.errors);
  const auto because_saturated = static_cast<std::uint8_t>(InvalidReason::saturated);
  result.image.reason = (measured.saturated != 0).select(because_saturated, result.image.reason);
  result.phase_noise_cycles = median_phase_noise_cycles(measured);
  return result;
}

UnwrapResult unwrap(const Frame& frame, const SensorModel& sensor, const UnwrapOptions& options) {
  return Unwrapper(sensor, options).unwrap(frame);
}

}  // namespace tofmap
