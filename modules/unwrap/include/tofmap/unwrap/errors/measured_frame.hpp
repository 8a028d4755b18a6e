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

/// A frame with what is known of its errors: what every method of unwrapping starts from.
struct MeasuredFrame {
  DualFrequencyFrame returns;  ///< phases are NaN at both frequencies where either has no return;
                               ///< B is matched to A (MatchedExposure) for `joint` and `jump`
  ImageU8 valid;               ///< not 0 where both frequencies have one
  ImageU8 saturated;           ///< not 0 where one of them was too strong for that
  PhaseNoise noise;            ///< estimated
  ImageF ambient;              ///< by which factor it differs in parts of the image; empty: nowhere
  PhaseSigma sigma;            ///< of the noise
  FrameErrors errors;          ///< of joint and jump; of others nothing is known
  double residual_sigma_m = 0;  ///< of the residual between the frequencies, besides noise
};

/// Measures the frames of one camera, in their order: noise, systematic errors, and the motion
/// between the exposures. What it says of a frame depends on the frames before it, since the camera
/// becomes better known; unwrapping what it returns depends on nothing else, so that frames
/// measured one after the other can be unwrapped side by side.
class FrameMeasurer {
 public:
  /// Throws UsageError if options are not allowed.
  FrameMeasurer(const SensorModel& sensor, const UnwrapOptions& options);

  /// Looks at the first frames of a recording, so that the camera is known from the first one on.
  /// Call it before any other; frames are measured again afterwards.
  void look_ahead(std::span<const DualFrequencyFrame> frames);

  /// Throws UsageError if the frame's images differ in size.
  MeasuredFrame measure(const DualFrequencyFrame& frame);

  /// How many frames are worth looking ahead.
  static constexpr int frames_ahead = 8;

  /// All that later frames depend on, to the bit. Reading throws std::exception if it is damaged.
  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  UnwrapLimits limits_;
  double saturation_amplitude_;
  std::optional<ErrorTracker> tracker_;  ///< of methods that compare the frequencies
};

/// The median of the noise of A's phase over the pixels with a return, cycles; 0 if there are none.
double median_phase_noise_cycles(const MeasuredFrame& frame);

}  // namespace tofmap
