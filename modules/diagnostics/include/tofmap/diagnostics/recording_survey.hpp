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

/// What a look at every frame of a recording tells.
struct RecordingSurvey {
  int frames = 0;
  std::vector<std::string> damages;  ///< of frames that could not be read
  int without_amplitude = 0;         ///< frames
  int without_return = 0;            ///< frames of which no pixel has one
  int repeated = 0;                  ///< frames with the phases of the frame before them
  int repeated_single = 0;  ///< frames with the phases of the frame before at one frequency alone
  std::vector<std::string>
      constant_images;         ///< phases that are the same wherever there is a return
  double no_return_share = 0;  ///< of all pixels
  double saturated_share = 0;
  double median_period_s = 0;
  double longest_gap_s = 0;
  int frame_before_gap = 0;
  std::optional<std::string> axial_depth_warning;  ///< see axial_depth.hpp
  std::optional<ResidualSurvey>
      residual;        ///< if some hundred pixels have returns at both frequencies
  ErrorSurvey errors;  ///< of some frames, spread over the recording
};

/// Whether a frame has the phases of the one before it.
bool repeats(const DualFrequencyFrame& frame, const DualFrequencyFrame& last);

/// So many such frames as a sentence; nothing if there are none.
std::optional<std::string> repetition_warning(int repeated);

/// Reads all frames. `keep_going` is asked before each, with the number done; false ends it.
RecordingSurvey survey_recording(const SequenceReader& recording,
                                 const std::function<bool(int frames_done)>& keep_going = {});

/// What of it is likely to be a mistake, in sentences with the remedy.
std::vector<std::string> warnings_about(const RecordingSurvey& survey, const SensorModel& sensor);

}  // namespace tofmap
