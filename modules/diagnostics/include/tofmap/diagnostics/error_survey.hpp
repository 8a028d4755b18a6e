// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/unwrap/errors/measured_frame.hpp>

namespace tofmap {

/// What the frames of a recording show of the camera's errors.
struct ErrorSurvey {
  CameraErrors camera;       ///< as the last frame left it
  double flow_px = 0;        ///< how far the image moves from A's exposure to B's; median
  double ambient_share = 0;  ///< of the pixels, those with more noise than their amplitudes explain
  double ambient_factor =
      1;  ///< mean factor of their noise; regions are smoothed, so at least this
  bool has_amplitudes = true;  ///< without them, `ambient_*` compare with the rest of the image
  int frames = 0;
};

/// Sums up measured frames, in their order.
class ErrorTally {
 public:
  void add(const MeasuredFrame& frame);
  ErrorSurvey survey() const;

 private:
  CameraErrors camera_;
  std::vector<float> flows_px_;
  double pixels_ = 0;
  double ambient_pixels_ = 0;
  double ambient_factors_ = 0;
  bool has_amplitudes_ = true;
};

/// The survey of frames of one camera, in their order.
ErrorSurvey survey_errors(const std::vector<DualFrequencyFrame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& options = {});

/// What was found and what unwrapping does about it, in sentences. Empty for a camera without such
/// errors.
std::vector<std::string> remarks_about(const ErrorSurvey& survey);

/// What makes ranges and maps wrong although unwrapping allows for it, in sentences with the
/// remedy.
std::vector<std::string> warnings_about(const ErrorSurvey& survey);

}  // namespace tofmap
