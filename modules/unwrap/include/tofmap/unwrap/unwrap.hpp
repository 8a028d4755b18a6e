// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/common/unwrap_result.hpp>
#include <tofmap/unwrap/errors/measured_frame.hpp>
#include <tofmap/unwrap/joint/wrap_count_estimate.hpp>
#include <tofmap/unwrap/jump/jump_estimate.hpp>

namespace tofmap {

/// Finds how many wavelengths to add to the phase of A in every pixel, for the frames of one camera
/// (Droeschel, Holz, Behnke: Multi-frequency Phase Unwrapping for Time-of-Flight Cameras, 2010;
/// docs/unwrapping.md).
///
/// range_m is radial: (phase_a + n) λ_A, or for `joint` what both frequencies say together. Pixels
/// without a return at either frequency are invalid (no_return) and take no part, for every
/// method, so that methods compare. `joint` makes those invalid (ambiguous) that have two equally
/// likely counts which the pair of frequencies cannot tell apart. Pixels whose amplitude reaches
/// the sensor's saturation_amplitude are as without a return, but with a reason of their own
/// (saturated). sigma_m is what the phase noise, estimated from each frame, makes of the range.
/// confidence is the probability that the count is right. That of `joint` is calibrated
/// (docs/unwrapping.md has the measurement); those of the other methods order pixels.
/// `joint` and `jump` estimate the camera's systematic errors over the frames so far, so that these
/// come in their order; the same frames and options give the same bits. To unwrap frames side by
/// side let one FrameMeasurer measure all, and an Unwrapper a thread unwrap what it returns. The
/// object keeps its buffers, so that frames of one size cost few allocations. One thread at a time.
class Unwrapper {
 public:
  /// Throws UsageError if options are not allowed.
  Unwrapper(const SensorModel& sensor, const UnwrapOptions& options);

  /// Looks at the first frames of a recording, so that the camera is known from the first one on.
  /// Call it before any other; the frames are unwrapped afterwards.
  void look_ahead(std::span<const DualFrequencyFrame> frames) { measurer_.look_ahead(frames); }

  /// The next frame of the camera. Throws UsageError if its images differ in size.
  UnwrapResult unwrap(const DualFrequencyFrame& frame);

  /// A frame that was measured for the same sensor and options; depends on no other.
  UnwrapResult unwrap(const MeasuredFrame& measured);

 private:
  UnwrapOptions options_;
  UnwrapMethod method_;
  UnwrapLimits limits_;
  FrameMeasurer measurer_;
  WrapCountEstimator count_estimator_;
  JumpEstimator jump_estimator_;
};

/// One frame by itself.
UnwrapResult unwrap(const DualFrequencyFrame& frame, const SensorModel& sensor,
                    const UnwrapOptions& options);

}  // namespace tofmap
