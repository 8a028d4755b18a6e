// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/errors/measured_frame.hpp"

#include "errors/ambient_noise.hpp"
#include "errors/median.hpp"
#include "tofmap/unwrap/errors/phase_noise.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Throws UsageError unless the frame has these frequencies and all its images have the same size.
void check(const Frame& frame, std::size_t frequencies) {
  if (frame.frequencies() != frequencies) {
    throw UsageError("unwrap: frame " + std::to_string(frame.index) + " has " +
                     counted(frame.frequencies(), "frequency", "frequencies") +
                     ", but the sensor has " + std::to_string(frequencies));
  }
  const auto fits = [&](const ImageF& image) { return same_size(image, frame.phases.front()); };
  const bool agree = std::ranges::all_of(frame.phases, fits) &&
                     (!frame.has_amplitude() || (frame.amplitudes.size() == frequencies &&
                                                 std::ranges::all_of(frame.amplitudes, fits)));
  if (!agree) {
    throw UsageError("unwrap: frame " + std::to_string(frame.index) +
                     ": images differ in size; phases and amplitudes must have the same size, or "
                     "amplitudes must be empty");
  }
}

/// Flags pixels that one frequency makes invalid: `lit` becomes 0 where the phase is not finite or
/// there is no light, and `saturated` 1 where there is too much.
TOFMAP_VECTOR_CLONES void mark_unusable(int pixels, const float* phase, const float* amplitude,
                                        float saturation, std::uint8_t* lit,
                                        std::uint8_t* saturated) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float present = 0 * phase[i];  // NaN if the phase is infinite or missing
    const bool is_lit = present == 0 && amplitude[i] > 0;
    lit[i] = is_lit ? lit[i] : 0;
    saturated[i] = amplitude[i] >= saturation ? 1 : saturated[i];
  }
}

/// A pixel is saturated only if it is lit, and valid only if it is not saturated.
void finish_flags(ImageU8& valid, ImageU8& saturated) {
  saturated *= valid;
  valid *= 1 - saturated;
}

/// Sets the phases of invalid pixels to NaN.
TOFMAP_VECTOR_CLONES void keep_valid(int pixels, const std::uint8_t* valid, float* phase) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) phase[i] = valid[i] != 0 ? phase[i] : nan;
}

/// Measures valid pixels and noise of a frame, but no systematic errors. A pixel is valid if it has
/// a finite phase and some light at all frequencies, and none is saturated.
MeasuredFrame measured_alone(const Frame& frame, double saturation_amplitude) {
  const Eigen::Index rows = frame.rows();
  const Eigen::Index cols = frame.cols();
  MeasuredFrame out;
  out.returns = frame;
  out.valid.setOnes(rows, cols);
  out.saturated.setZero(rows, cols);
  const auto pixels = static_cast<int>(out.valid.size());
  const ImageF lit = frame.has_amplitude() ? ImageF() : ImageF::Ones(rows, cols);
  const bool can_saturate = frame.has_amplitude() && saturation_amplitude > 0;
  const float saturation = can_saturate ? static_cast<float>(saturation_amplitude)
                                        : std::numeric_limits<float>::infinity();
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    const ImageF& amplitude = frame.has_amplitude() ? frame.amplitudes[f] : lit;
    mark_unusable(pixels, frame.phases[f].data(), amplitude.data(), saturation, out.valid.data(),
                  out.saturated.data());
  }
  finish_flags(out.valid, out.saturated);
  for (ImageF& phase : out.returns.phases) keep_valid(pixels, out.valid.data(), phase.data());
  out.noise = estimate_phase_noise(out.returns);
  out.ambient = find_ambient_noise(out.returns, out.noise);
  out.sigma = PhaseSigma(out.returns, out.noise, out.ambient);
  out.errors.resize(frame.frequencies());
  out.residual_sigma_m.resize(frame.frequencies());
  return out;
}

/// Share of samples that are as predicted (FrameErrors::support) from which on the motion that one
/// frequency tells is that of the others, too.
constexpr double telling_support = 0.8;

/// Largest time to an exposure, relative to that in which a motion was found, for which the motion
/// tells that of the exposure. Its uncertainty is then that of a motion that was searched for.
constexpr double farthest_share = 3;

/// Replaces the images of frequency `b` by those matched to the first frequency, and fills in the
/// estimated errors of camera and frame.
void take_matched(ErrorTracker::Tracked tracked, const PairLimits& limits, std::size_t b,
                  MeasuredFrame& frame) {
  // The tracker does not see errors that vary within the image, such as multipath. Residuals
  // smaller than this share of the residual step must not count as evidence against a wrap count.
  constexpr double least_share_of_step = 1.0 / 30;
  frame.returns.phases[b] = std::move(tracked.b.phase_b);
  if (frame.returns.has_amplitude()) {
    frame.returns.amplitudes[b] = std::move(tracked.b.amplitude_b);
  }
  frame.sigma.cycles[b] = std::move(tracked.b.sigma_b_cycles);
  frame.residual_sigma_m[b] =
      std::max(tracked.errors.camera.systematic_m, least_share_of_step * residual_step_m(limits));
  frame.errors[b] = std::move(tracked.errors);
}

/// Times of exposures relative to that of frequency `leader`, from that of the first one on.
/// Without known times, the frequencies are taken to be exposed one after another. Empty if the
/// first one and the leader are exposed at the same time.
std::vector<double> relative_times(const Modulation& modulation, std::size_t leader) {
  const std::vector<double>& offsets_s = modulation.exposure_offsets_s;
  std::vector<double> times;
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    times.push_back(offsets_s.empty() ? static_cast<double>(f) : offsets_s[f] - offsets_s[0]);
  }
  const double leader_time = times[leader];
  if (leader_time == 0) return {};
  for (double& time : times) time /= leader_time;
  return times;
}

}  // namespace

FrameMeasurer::FrameMeasurer(const SensorModel& sensor, const UnwrapOptions& options)
    : limits_(unwrap_limits(sensor, options.max_range_m)),
      saturation_amplitude_(sensor.saturation_amplitude) {
  const UnwrapMethod method = options.method;
  const bool compares_frequencies = method == UnwrapMethod::joint || method == UnwrapMethod::jump;
  if (!compares_frequencies || !options.systematic_errors) return;
  for (std::size_t f = 1; f < limits_.frequencies(); ++f) {
    trackers_.emplace_back(limits_.pair(0, f),
                           options.correct_exposure ? sensor.camera : CameraModel());
  }
  order_ = others_by_wavelength(limits_.wavelengths_m);
  std::ranges::reverse(order_);
  relative_times_ = relative_times(sensor.modulation, order_.empty() ? 0 : order_.front());
}

void FrameMeasurer::look_ahead(std::span<const Frame> frames) {
  if (trackers_.empty()) return;
  for (const Frame& frame : frames) measure(frame);
  for (ErrorTracker& tracker : trackers_) tracker.forget_last_frame();
}

MeasuredFrame FrameMeasurer::measure(const Frame& frame) {
  check(frame, limits_.frequencies());
  MeasuredFrame measured = measured_alone(frame, saturation_amplitude_);
  std::optional<ErrorTracker::Expected> led;  // the motion of the leader
  for (const std::size_t b : order_) {
    ErrorTracker& tracker = trackers_[b - 1];
    std::optional<ErrorTracker::Expected> expected;
    if (led && std::abs(relative_times_[b]) <= farthest_share) {
      const double share = relative_times_[b];
      expected = {{share * led->motion.translation_m, share * led->motion.rotation_rad},
                  share,
                  led->is_late};
    }
    take_matched(tracker.track(measured.returns, measured.sigma, b, expected), limits_.pair(0, b),
                 b, measured);
    const FrameErrors& errors = measured.errors[b];
    if (b == order_.front() && !relative_times_.empty() && errors.support >= telling_support) {
      led = {errors.motion, 1, tracker.is_late()};
    }
  }
  return measured;
}

void FrameMeasurer::save(ByteWriter& out) const {
  for (const ErrorTracker& tracker : trackers_) tracker.save(out);
}

void FrameMeasurer::load(ByteReader& in) {
  for (ErrorTracker& tracker : trackers_) tracker.load(in);
}

double median_phase_noise_cycles(const MeasuredFrame& frame) {
  const ImageF& sigma = frame.sigma.cycles.front();
  std::vector<float> sigmas;
  sigmas.reserve(static_cast<std::size_t>(sigma.size()));
  std::copy_if(sigma.data(), sigma.data() + sigma.size(), std::back_inserter(sigmas),
               [](float s) { return std::isfinite(s); });
  return sigmas.empty() ? 0 : median_of_positive(sigmas);
}

}  // namespace tofmap
