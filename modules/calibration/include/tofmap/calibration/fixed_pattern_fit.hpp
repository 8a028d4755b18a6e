// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/calibration/recording_samples.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// A frame whose true ranges are known.
struct ReferencedFrame {
  Frame frame;
  ImageF reference_m;  ///< range of each pixel when A was exposed, metres; NaN where unknown
  /// By how much the range of each pixel changes until the next frame of the recording, metres.
  /// NaN where unknown. Empty if all are.
  ImageF change_m;
};

/// Calls its argument with each of some frames. It may be called several times, and gives the same
/// frames each time.
using ReferencedFrames =
    std::function<void(const std::function<void(const ReferencedFrame&)>& visit)>;

/// The frames of a recording with these indices and their references, after `calibrate(frame)` with
/// `calibration`. Leaves out frames that are damaged or have no reference. The changes of ranges
/// follow from the reference of the next frame of the recording. `keep_going` is called before a
/// frame is read; if it returns false, no more frames are given. It may be empty. `recording` must
/// outlive the result.
ReferencedFrames referenced_frames(const SequenceReader& recording, std::vector<int> indices,
                                   ReferenceRanges reference, CameraCalibration calibration,
                                   std::function<bool()> keep_going = {});

/// How many times fit_fixed_pattern() goes through the frames. The first time finds where the
/// errors of a pixel lie, the second time their noise without outliers, the third time the result.
inline constexpr int pattern_averagings = 3;

/// The fixed pattern of one frequency.
struct PatternEstimate {
  /// The error of each pixel, measured minus true, in metres, shrunk towards 0 by its uncertainty.
  /// NaN for pixels without a measurement. All others are 0 if the pattern is not significant.
  ImageF error_m;
  /// Standard deviation of the true errors over the pixels. Metres; 0 if the pattern is not
  /// significant.
  double sigma_m = 0;
  /// Standard deviation of the noise of a pixel's mean error, before shrinking: the median over
  /// the pixels. Metres; NaN if no pixel has two measurements.
  double noise_m = 0;
  /// Expected standard deviation of the error that is left after `error_m` has been subtracted:
  /// root mean square over the pixels. Metres; 0 if the pattern is not significant.
  double remaining_m = 0;
  std::size_t pixels = 0;  ///< number of pixels with a measurement
  /// When the frequency was exposed after A, in frame periods, as the change of ranges shows it. 0
  /// if ranges do not change.
  double delay_frames = 0;
  /// Share of a periodic error with four periods per wavelength that averaging over the frames
  /// leaves in a pixel: the median over the pixels of |mean of exp(2πi 4φ)|, where φ is the phase
  /// of the reference. 1 if the ranges of pixels did not change; such a pattern contains errors of
  /// the scene. NaN without measurements.
  double periodic_share = 0;

  bool is_significant() const { return sigma_m > 0; }
};

/// Estimates the fixed pattern of a camera from frames whose other errors have been subtracted
/// (docs/calibration.md, equations 3 to 6). The result has an element for each frequency.
///
/// Averages the remaining error of each pixel over the frames, weighted by inverse variance, and
/// shrinks it by its standard error, which follows from the spread over the frames (empirical
/// Bayes). The standard deviation of the pattern is that of a random-effects model (Paule and
/// Mandel 1982); it is significant if the means differ by more than their noise explains. The mean
/// over the pixels is taken out: the offset of the frequency contains it. The motion of the camera
/// between the exposures is taken out, too: it is the part of the errors that is proportional to
/// the change of the range from frame to frame (fixed-effects regression).
///
/// Leaves out saturated pixels, pixels without a return or a reference, and errors of more than
/// `max_error_m` that noise does not explain. Throws UsageError if a reference has another size
/// than its frame.
std::vector<PatternEstimate> fit_fixed_pattern(const ReferencedFrames& frames,
                                               const SensorModel& sensor, double max_error_m);

}  // namespace tofmap
