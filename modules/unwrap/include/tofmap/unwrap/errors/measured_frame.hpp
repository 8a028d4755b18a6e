// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <optional>
#include <span>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

/// A frame and its estimated errors: the input of every method of unwrapping. All images have the
/// size of the frame.
struct MeasuredFrame {
  /// The frame, with phases that are NaN at both frequencies where `valid` is 0. For `joint` and
  /// `jump`, B is matched to A (MatchedExposure).
  DualFrequencyFrame returns;
  /// 1 where both frequencies have a return and none is saturated, else 0.
  ImageU8 valid;
  /// 1 where the amplitude of either frequency reaches the sensor's saturation_amplitude, else 0.
  ImageU8 saturated;
  /// Estimated noise of the phases.
  PhaseNoise noise;
  /// Factor by which ambient light raises the noise of each pixel; empty: 1 everywhere.
  ImageF ambient;
  /// Standard deviation of the phase noise of each pixel, from `noise` and `ambient`.
  PhaseSigma sigma;
  /// Estimated for `joint` and `jump`; for the other methods as constructed.
  FrameErrors errors;
  /// Standard deviation of the inter-frequency residual besides noise; 0 for methods whose
  /// systematic errors are not estimated.
  double residual_sigma_m = 0;
};

/// Estimates noise, systematic errors and the motion between exposures for the frames of one
/// camera, which must be passed in the order of their recording: the estimate for a frame depends
/// on the frames before it. Unwrapping a measured frame depends on no other frame, so measured
/// frames can be unwrapped in parallel.
class FrameMeasurer {
 public:
  /// Throws UsageError if the range limit needs more than 255 wrap counts (unwrap_limits). Does not
  /// check the other options; OptionTable checks their ranges when they are set.
  FrameMeasurer(const SensorModel& sensor, const UnwrapOptions& options);

  /// Learns the camera's systematic errors from the first frames of a recording, so that they are
  /// known when the first frame is measured. Call this before any other function, then pass the
  /// same frames to measure().
  void look_ahead(std::span<const DualFrequencyFrame> frames);

  /// Measures the next frame. Throws UsageError if the frame's images differ in size.
  MeasuredFrame measure(const DualFrequencyFrame& frame);

  /// The number of frames that look_ahead() should be given.
  static constexpr int frames_ahead = 8;

  /// Writes the complete state in binary form: after load(), later frames give the same bits as
  /// without saving.
  void save(std::ostream& out) const;

  /// Reads a state that save() wrote for the same sensor and options. Throws an std::exception if
  /// the data is damaged.
  void load(std::istream& in);

 private:
  UnwrapLimits limits_;
  double saturation_amplitude_;
  std::optional<ErrorTracker> tracker_;  ///< empty if systematic errors are not estimated
};

/// Median of the noise of A's phase over the pixels with a return, cycles; 0 if no pixel has one.
double median_phase_noise_cycles(const MeasuredFrame& frame);

}  // namespace tofmap
