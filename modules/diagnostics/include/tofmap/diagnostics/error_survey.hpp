// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/unwrap/errors/measured_frame.hpp>

namespace tofmap {

/// What the frames of a recording show of the camera's errors.
struct ErrorSurvey {
  CameraErrors camera;        ///< as the last frame left it
  double flow_px = 0;         ///< how far the image moves from A's exposure to B's; median
  double ambient_share = 0;   ///< of the pixels, those whose noise ambient light raises
  double ambient_factor = 1;  ///< by how much, there; mean
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
};

/// The survey of frames of one camera, in their order.
ErrorSurvey survey_errors(const std::vector<DualFrequencyFrame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& options = {});

/// What of it is worth telling, in sentences: what was found, and what is done about it. Empty for
/// a camera without such errors.
std::vector<std::string> remarks_about(const ErrorSurvey& survey);

}  // namespace tofmap
