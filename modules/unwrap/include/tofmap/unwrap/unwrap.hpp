// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/common/compared_pair.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/common/unwrap_result.hpp>
#include <tofmap/unwrap/errors/measured_frame.hpp>
#include <tofmap/unwrap/joint/wrap_count_estimate.hpp>
#include <tofmap/unwrap/jump/jump_estimate.hpp>

namespace tofmap {

/// Finds the wrap count of the first frequency in every pixel of the frames of one camera
/// (Droeschel, Holz, Behnke: Multi-frequency Phase Unwrapping for Time-of-Flight Cameras, IROS
/// 2010; docs/unwrapping.md).
///
/// The planes of the resulting RangeImage have the size of the frame:
///   range_m     radial: (phase + n) λ of the first frequency, with the wrap count n. For `joint`,
///               by default, the weighted mean of the ranges of all frequencies (fuse_ranges). For
///               `jump`, `paper` and `single`, that of the first frequency of compared_pair().
///   sigma_m     standard deviation of range_m by phase noise, which is estimated for each frame.
///   confidence  the probability that the wrap count is right. The confidence of `joint` is
///               calibrated (docs/unwrapping.md has the measurement); that of other methods only
///               ranks the pixels of a frame.
///
/// With a single frequency, `joint` gives wrap counts relative to the nearest pixel of each region,
/// and so does `single`: the absolute ones are not known (are_absolute), and the confidence says
/// so.
///
/// Invalid pixels:
///   no_return   no return at one of the frequencies. These pixels take no part in any method, so
///               that the methods can be compared.
///   saturated   the amplitude at one of the frequencies reaches the sensor's saturation_amplitude.
///               These pixels are otherwise treated like those without a return.
///   ambiguous   of `joint` alone: the runner-up is at least a tenth as probable as the chosen wrap
///               count, and the frequencies cannot tell the two apart.
///
/// `joint` and `jump` estimate the camera's systematic errors from all frames so far, so frames
/// must be passed in the order of their recording. The same frames and options give the same bits.
/// To unwrap frames in parallel, measure all of them with one FrameMeasurer, in order, and pass
/// the measured frames to one Unwrapper per thread.
///
/// The object keeps its buffers, so frames of the same size need few allocations. It must not be
/// used by two threads at once.
class Unwrapper {
 public:
  /// Throws UsageError if the range limit needs more than 255 wrap counts (unwrap_limits), or if
  /// the method needs frequencies that the sensor does not have. Does not check the other options;
  /// OptionTable checks their ranges when they are set.
  Unwrapper(const SensorModel& sensor, const UnwrapOptions& options);

  /// Learns the camera's systematic errors from the first frames of a recording, so that they are
  /// known when the first frame is unwrapped. Call this before any other function, then pass the
  /// same frames to unwrap().
  void look_ahead(std::span<const Frame> frames) { measurer_.look_ahead(frames); }

  /// Measures and unwraps the next frame of the camera. Throws UsageError if the frame's images
  /// differ in size.
  UnwrapResult unwrap(const Frame& frame);

  /// Unwraps a frame that a FrameMeasurer of the same sensor and options has measured. The result
  /// does not depend on frames that were unwrapped before.
  UnwrapResult unwrap(const MeasuredFrame& measured);

 private:
  UnwrapResult unwrap_pair(const MeasuredFrame& measured);
  UnwrapResult unwrap_relative(const MeasuredFrame& measured);
  UnwrapResult unwrap_counted(const MeasuredFrame& measured);

  UnwrapOptions options_;
  UnwrapMethod method_;
  UnwrapLimits limits_;
  std::vector<std::size_t> counting_order_;
  ComparedPair pair_;
  PairLimits pair_limits_;  ///< of methods that find jumps
  FrameMeasurer measurer_;
  WrapCountEstimator count_estimator_;
  JumpEstimator jump_estimator_;
};

/// Unwraps a single frame, without knowledge from other frames. Throws UsageError if the range
/// limit needs more than 255 wrap counts, or if the frame's images differ in size.
UnwrapResult unwrap(const Frame& frame, const SensorModel& sensor, const UnwrapOptions& options);

}  // namespace tofmap
