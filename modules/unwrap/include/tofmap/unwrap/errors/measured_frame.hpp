// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

class ByteReader;
class ByteWriter;

/// A frame and its estimated errors: the input of every method of unwrapping. All images have the
/// size of the frame.
struct MeasuredFrame {
  /// The frame, with phases that are NaN at all frequencies where `valid` is 0. For `joint` and
  /// `jump`, the other frequencies are matched to the first one (MatchedExposure).
  Frame returns;
  /// 1 where all frequencies have a return and none is saturated, else 0.
  ImageU8 valid;
  /// 1 where the amplitude of a frequency reaches the sensor's saturation_amplitude, else 0.
  ImageU8 saturated;
  /// Estimated noise of the phases of each frequency.
  std::vector<PhaseNoise> noise;
  /// Factor by which ambient light raises the noise of each pixel; empty: 1 everywhere.
  ImageF ambient;
  /// Standard deviation of the phase noise of each pixel, from `noise` and `ambient`.
  PhaseSigma sigma;
  /// The errors of each frequency relative to the first one. Those of the first one are as
  /// constructed; those of all are for methods other than `joint` and `jump`.
  std::vector<FrameErrors> errors;
  /// Standard deviation, besides noise, of the inter-frequency residual of each frequency relative
  /// to the first one; 0 for the first one, and for methods whose systematic errors are not
  /// estimated.
  std::vector<double> residual_sigma_m;
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
  void look_ahead(std::span<const Frame> frames);

  /// Measures the next frame. Throws UsageError if the frame does not have the sensor's
  /// frequencies, or if its images differ in size.
  MeasuredFrame measure(const Frame& frame);

  /// The number of frames that look_ahead() should be given.
  static constexpr int frames_ahead = 8;

  /// Writes the complete state in binary form: after load(), later frames give the same bits as
  /// without saving.
  void save(ByteWriter& out) const;

  /// Reads a state that save() wrote for the same sensor and options. Throws InputError if the
  /// bytes are damaged.
  void load(ByteReader& in);

 private:
  UnwrapLimits limits_;
  double saturation_amplitude_;
  /// A tracker for each frequency but the first; none if systematic errors are not estimated.
  std::vector<ErrorTracker> trackers_;
  /// The frequencies of the trackers by wavelength: the shortest one first, whose residual tells
  /// the motion most precisely, and which leads the others.
  std::vector<std::size_t> order_;
  /// Time from the exposure of the first frequency to that of each, relative to that of the leader;
  /// empty if the leader is exposed with the first one.
  std::vector<double> relative_times_;
};

/// Median of the noise of the first frequency's phase over the pixels with a return, cycles; 0 if
/// no pixel has one.
double median_phase_noise_cycles(const MeasuredFrame& frame);

}  // namespace tofmap
