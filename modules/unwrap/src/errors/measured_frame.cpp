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
#include <string>
#include <utility>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Throws UsageError unless all images of the frame have the same size.
void check(const DualFrequencyFrame& frame) {
  const bool agree = same_size(frame.phase_a, frame.phase_b) &&
                     (!frame.has_amplitude() || (same_size(frame.phase_a, frame.amplitude_a) &&
                                                 same_size(frame.phase_a, frame.amplitude_b)));
  if (!agree) {
    throw UsageError("unwrap: frame " + std::to_string(frame.index) +
                     ": images differ in size; phases and amplitudes must have the same size, or "
                     "amplitudes must be empty");
  }
}

/// Flags valid and saturated pixels, and sets the phases of all invalid pixels to NaN. A pixel is
/// valid if it has a finite phase and some light at both frequencies, and neither is saturated.
TOFMAP_VECTOR_CLONES void keep_lit(int pixels, const float* amplitude_a, const float* amplitude_b,
                                   float saturation, float* phase_a, float* phase_b,
                                   std::uint8_t* valid, std::uint8_t* saturated) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float a = amplitude_a[i];
    const float b = amplitude_b[i];
    // NaN if a phase is infinite or missing.
    const float present = 0 * phase_a[i] + 0 * phase_b[i];
    const bool is_lit = present == 0 && a > 0 && b > 0;
    const bool is_saturated = is_lit && (a >= saturation || b >= saturation);
    const bool is_valid = is_lit && !is_saturated;
    valid[i] = is_valid ? 1 : 0;
    saturated[i] = is_saturated ? 1 : 0;
    phase_a[i] = is_valid ? phase_a[i] : nan;
    phase_b[i] = is_valid ? phase_b[i] : nan;
  }
}

/// Measures valid pixels and noise of a frame, but no systematic errors.
MeasuredFrame measured_alone(const DualFrequencyFrame& frame, double saturation_amplitude) {
  check(frame);
  const Eigen::Index rows = frame.phase_a.rows();
  const Eigen::Index cols = frame.phase_a.cols();
  MeasuredFrame out;
  out.returns = frame;
  out.valid.resize(rows, cols);
  out.saturated.resize(rows, cols);
  const ImageF lit = frame.has_amplitude() ? ImageF() : ImageF::Ones(rows, cols);
  const bool can_saturate = frame.has_amplitude() && saturation_amplitude > 0;
  keep_lit(static_cast<int>(out.valid.size()),
           frame.has_amplitude() ? frame.amplitude_a.data() : lit.data(),
           frame.has_amplitude() ? frame.amplitude_b.data() : lit.data(),
           can_saturate ? static_cast<float>(saturation_amplitude)
                        : std::numeric_limits<float>::infinity(),
           out.returns.phase_a.data(), out.returns.phase_b.data(), out.valid.data(),
           out.saturated.data());
  out.noise = estimate_phase_noise(out.returns);
  out.ambient = find_ambient_noise(out.returns, out.noise);
  out.sigma = PhaseSigma(out.returns, out.noise, out.ambient);
  return out;
}

/// Replaces B by B matched to A, and fills in the estimated errors of camera and frame.
void match_exposures(ErrorTracker& tracker, const UnwrapLimits& limits, MeasuredFrame& frame) {
  // The tracker does not see errors that vary within the image, such as multipath. Residuals
  // smaller than this share of the residual step must not count as evidence against a wrap count.
  constexpr double least_share_of_step = 1.0 / 30;
  ErrorTracker::Tracked tracked = tracker.track(frame.returns, frame.sigma);
  frame.returns.phase_b = std::move(tracked.b.phase_b);
  if (frame.returns.has_amplitude()) frame.returns.amplitude_b = std::move(tracked.b.amplitude_b);
  frame.sigma.b_cycles = std::move(tracked.b.sigma_b_cycles);
  frame.residual_sigma_m =
      std::max(tracked.errors.camera.systematic_m, least_share_of_step * residual_step_m(limits));
  frame.errors = std::move(tracked.errors);
}

}  // namespace

FrameMeasurer::FrameMeasurer(const SensorModel& sensor, const UnwrapOptions& options)
    : limits_(unwrap_limits(sensor, options.max_range_m)),
      saturation_amplitude_(sensor.saturation_amplitude) {
  const UnwrapMethod method = options.method;
  const bool compares_frequencies = method == UnwrapMethod::joint || method == UnwrapMethod::jump;
  if (compares_frequencies && options.systematic_errors) {
    tracker_.emplace(limits_, options.correct_exposure ? sensor.camera : CameraModel());
  }
}

void FrameMeasurer::look_ahead(std::span<const DualFrequencyFrame> frames) {
  if (!tracker_) return;
  for (const DualFrequencyFrame& frame : frames) measure(frame);
  tracker_->forget_last_frame();
}

MeasuredFrame FrameMeasurer::measure(const DualFrequencyFrame& frame) {
  MeasuredFrame measured = measured_alone(frame, saturation_amplitude_);
  if (tracker_) match_exposures(*tracker_, limits_, measured);
  return measured;
}

void FrameMeasurer::save(std::ostream& out) const {
  if (tracker_) tracker_->save(out);
}

void FrameMeasurer::load(std::istream& in) {
  if (tracker_) tracker_->load(in);
}

double median_phase_noise_cycles(const MeasuredFrame& frame) {
  const ImageF& sigma = frame.sigma.a_cycles;
  std::vector<float> sigmas;
  sigmas.reserve(static_cast<std::size_t>(sigma.size()));
  std::copy_if(sigma.data(), sigma.data() + sigma.size(), std::back_inserter(sigmas),
               [](float s) { return std::isfinite(s); });
  return sigmas.empty() ? 0 : median_of_positive(sigmas);
}

}  // namespace tofmap
