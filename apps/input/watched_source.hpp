// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>

namespace tofmap::app {

/// What the frames of a source tell about it.
struct SourceSurvey {
  std::vector<std::string> warnings;      ///< about the first frames
  std::vector<ResidualSurvey> residuals;  ///< none if there are warnings, or too few returns
  std::vector<double> times_s;            ///< timestamps of all undamaged frames
};

/// Warnings about a source, with what is known from mapping it: `errors` holds the systematic
/// errors that unwrapping has estimated, or is null, and `map_agrees` says whether the frames agree
/// on a map (frames_agree() of tofmap/pipeline). If they do, noise or a large offset between the
/// frequencies is no reason for a warning.
std::vector<std::string> warnings_about(const SourceSurvey& survey,
                                        const ErrorSurvey* errors = nullptr,
                                        bool map_agrees = false);

/// Surveys a recording that is to be unwrapped with these options. Only its first frames are read.
SourceSurvey survey_source(const SequenceReader& recording, const UnwrapOptions& unwrap);

/// Passes on the frames of another source and checks them (docs/cameras.md). The first frames are
/// checked for wrong frequencies, for swapped images and for depths along the optical axis in place
/// of ranges; all frames are checked for gaps in time.
class WatchedSource final : public FrameSource {
 public:
  /// The frames are to be unwrapped with these options.
  WatchedSource(FrameSource& source, const UnwrapOptions& unwrap)
      : source_(source), unwrap_(unwrap) {}

  const SensorModel& sensor() const override { return source_.sensor(); }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// The survey of the frames so far.
  SourceSurvey survey();

 private:
  void survey_first();

  FrameSource& source_;
  UnwrapOptions unwrap_;
  std::vector<Frame> first_;
  std::optional<SourceSurvey> survey_;  ///< without times; empty until enough frames were read
  std::vector<double> times_s_;         ///< SourceSurvey::times_s
};

}  // namespace tofmap::app
