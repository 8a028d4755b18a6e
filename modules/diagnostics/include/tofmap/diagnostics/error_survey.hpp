// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tofmap/unwrap/errors/measured_frame.hpp>

namespace tofmap {

class ByteReader;
class ByteWriter;

/// The errors of a camera, as the frames of a recording show them.
struct ErrorSurvey {
  /// Systematic errors of each frequency relative to the first one, as estimated up to the last
  /// frame; those of the first one are 0.
  std::vector<CameraErrors> cameras;
  /// Median over the frames of the image motion from the first exposure to the one with the largest
  /// motion. Frames with more than a quarter of the image are left out: their images do not belong
  /// together. 0 if none is left.
  double flow_px = 0;
  /// Share of the valid pixels whose noise is at least 1.4 times what their amplitudes predict,
  /// 0 … 1. Ambient light raises the noise in this way.
  double ambient_share = 0;
  /// Mean factor by which the noise of these pixels exceeds the prediction. It is a lower bound,
  /// since the estimate is smoothed over the image.
  double ambient_factor = 1;
  /// Whether the last frame has amplitudes. Without amplitudes, `ambient_share` and
  /// `ambient_factor` compare the noise with that of the rest of the image.
  bool has_amplitudes = true;
  int frames = 0;  ///< number of frames with enough pixels to estimate systematic errors
};

/// The systematic errors of a frequency; null if they were not estimated.
inline const CameraErrors* camera_at(const ErrorSurvey& survey, std::size_t frequency) {
  return frequency < survey.cameras.size() ? &survey.cameras[frequency] : nullptr;
}

/// Collects an ErrorSurvey from measured frames.
class ErrorTally {
 public:
  /// Adds the next frame. Frames must be added in the order in which they were measured.
  void add(const MeasuredFrame& frame);

  /// The survey of the frames added so far.
  ErrorSurvey survey() const;

  /// Writes what was collected. A tally that loads it goes on to the same survey, to the bit.
  /// load() throws InputError if the bytes are damaged.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::vector<CameraErrors> cameras_;  ///< of the last frame, as in ErrorSurvey
  int frames_ = 0;                     ///< number of frames whose errors could be estimated
  std::vector<float> flows_px_;        ///< of those frames whose images belong together
  double pixels_ = 0;                  ///< valid pixels
  double ambient_pixels_ = 0;          ///< those with raised noise
  double ambient_factors_ = 0;         ///< sum of the factors of pixels with raised noise
  bool has_amplitudes_ = true;
};

/// Measures the frames of one camera, which must be in order, and returns their survey. Throws
/// UsageError if the options are not allowed or the images of a frame differ in size.
ErrorSurvey survey_errors(const std::vector<Frame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& options = {});

/// Sentences that say which errors were found and what unwrapping does about each of them. Empty if
/// all errors are small.
std::vector<std::string> remarks_about(const ErrorSurvey& survey);

/// Warnings, each with a remedy, about errors that make ranges and maps wrong although unwrapping
/// compensates for them: a periodic error of at least 1 cm, or of 2.5 cm if the frames agree on a
/// map (`map_agrees`).
std::vector<std::string> warnings_about(const ErrorSurvey& survey, bool map_agrees = false);

}  // namespace tofmap
