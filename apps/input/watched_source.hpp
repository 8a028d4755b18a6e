// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>

namespace tofmap::app {

/// Findings about the first frames of a source.
struct FirstFrames {
  std::vector<std::string> warnings;
  std::optional<ResidualSurvey> residual;  ///< empty if there are warnings, or too few returns
};

/// Passes on the frames of another source and checks them (docs/cameras.md). The first frames are
/// checked for wrong frequencies, for swapped images and for depths along the optical axis in place
/// of ranges; all frames are checked for gaps in time.
class WatchedSource final : public FrameSource {
 public:
  explicit WatchedSource(FrameSource& source) : source_(source) {}

  const SensorModel& sensor() const override { return source_.sensor(); }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// Warnings about the frames so far. `camera` holds the systematic errors that unwrapping has
  /// estimated, or is null.
  std::vector<std::string> warnings(const CameraErrors* camera = nullptr);

 private:
  void judge();

  FrameSource& source_;
  std::vector<DualFrequencyFrame> first_;
  std::optional<FirstFrames> judged_;  ///< empty until enough frames were read
  std::vector<double> times_s_;        ///< timestamps of all undamaged frames
};

/// The same warnings about a recording, of which only the first frames are read.
std::vector<std::string> warnings_about(const SequenceReader& recording,
                                        const CameraErrors* camera = nullptr);

}  // namespace tofmap::app
