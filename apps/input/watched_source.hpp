// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>

namespace tofmap::app {

/// What the first frames of a source show.
struct FirstFrames {
  std::vector<std::string> warnings;
  std::optional<ResidualSurvey> residual;  ///< if nothing is wrong with the images themselves
};

/// Passes the frames of another source on, and looks at them: at the first whether A and B belong
/// together, and are ranges along rays, and at all for gaps in time (docs/cameras.md).
class WatchedSource final : public FrameSource {
 public:
  explicit WatchedSource(FrameSource& source) : source_(source) {}

  const SensorModel& sensor() const override { return source_.sensor(); }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// What is suspicious about the frames so far. `camera` is what unwrapping found of the camera's
  /// errors, if it is known.
  std::vector<std::string> warnings(const CameraErrors* camera = nullptr);

 private:
  void judge();

  FrameSource& source_;
  std::vector<DualFrequencyFrame> first_;
  std::optional<FirstFrames> judged_;  ///< empty before the first frames have come
  std::vector<double> times_s_;
};

/// What is suspicious about a recording, in the same way.
std::vector<std::string> warnings_about(const SequenceReader& recording,
                                        const CameraErrors* camera = nullptr);

}  // namespace tofmap::app
