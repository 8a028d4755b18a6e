// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>

namespace tofmap {

/// Properties of a recording, from a pass over all of its frames.
struct RecordingSurvey {
  int frames = 0;                    ///< number of frames looked at, including damaged ones
  std::vector<std::string> damages;  ///< one message per frame that could not be read
  int without_amplitude = 0;         ///< number of frames without amplitudes
  int without_return = 0;  ///< number of frames in which no pixel has a return at all frequencies
  int repeated = 0;        ///< number of frames with the same phases as the previous frame
  /// Number of frames with the same phases as the previous frame at some frequencies only.
  int repeated_single = 0;
  /// File names of phase images that have the same phase in all pixels with a return.
  std::vector<std::string> constant_images;
  double no_return_share = 0;  ///< share of all pixels without a return at one frequency, 0 … 1
  double saturated_share = 0;  ///< share of all pixels that are saturated at one frequency, 0 … 1
  double median_period_s = 0;  ///< median time between consecutive frames; 0 if unknown
  double longest_gap_s = 0;    ///< longest time between consecutive frames; 0 if unknown
  int frame_before_gap = 0;    ///< index of the frame at which the longest gap begins
  std::optional<std::string> copied_images_warning;      ///< see copied_images.hpp
  std::optional<std::string> swapped_amplitude_warning;  ///< see swapped_amplitude.hpp
  std::optional<std::string> axial_depth_warning;        ///< see axial_depth.hpp
  std::vector<ResidualSurvey> residuals;  ///< without those of which too few pixels have returns
  ErrorSurvey errors;                     ///< of up to twelve frames, spread over the recording
};

/// A warning that `repeated` frames repeat the previous frame. Empty if `repeated` is 0.
std::optional<std::string> repetition_warning(int repeated);

/// A warning if frames are so far apart, or so near in time, that their times are hardly in
/// seconds. Empty otherwise; `median_period_s` is 0 if it is unknown.
std::optional<std::string> period_warning(double median_period_s);

/// Reads all frames of a recording and surveys them. `keep_going` is called before each frame with
/// the number of frames done; the survey ends early if it returns false. It may be empty.
RecordingSurvey survey_recording(const SequenceReader& recording,
                                 const std::function<bool(int frames_done)>& keep_going = {});

/// Warnings, each with a remedy, about properties of the recording that are probably mistakes.
std::vector<std::string> warnings_about(const RecordingSurvey& survey, const SensorModel& sensor);

}  // namespace tofmap
