// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/watched_source.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/axial_depth.hpp>
#include <tofmap/diagnostics/camera_warning.hpp>
#include <tofmap/diagnostics/copied_images.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>
#include <tofmap/diagnostics/swapped_amplitude.hpp>
#include <tofmap/unwrap/common/compared_pair.hpp>

namespace tofmap::app {
namespace {

/// The number of frames at the start of a source that are examined.
constexpr std::size_t enough = 12;

/// The survey of the first frames of a source, without times.
SourceSurvey survey_of(const std::vector<Frame>& first, const SensorModel& sensor,
                       const UnwrapOptions& unwrap) {
  SourceSurvey survey;
  if (auto warning = camera_warning(sensor.camera)) survey.warnings.push_back(*std::move(warning));
  for (const auto& warning :
       {frequency_warning(sensor, unwrap.max_range_m), pair_warning(unwrap, sensor),
        copied_images_warning(first), swapped_amplitude_warning(first),
        axial_depth_warning(first, sensor)}) {
    if (!warning) continue;
    survey.warnings.push_back(*warning);
    return survey;
  }
  survey.residuals = survey_residuals(first, sensor);
  return survey;
}

/// The times between the frames at these times.
std::vector<double> periods_between(const std::vector<double>& times_s) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < times_s.size(); ++i) periods_s.push_back(times_s[i] - times_s[i - 1]);
  return periods_s;
}

/// A warning if some frames are more than 3.5 median frame periods apart. Empty if there are none.
std::optional<std::string> gap_warning(const std::vector<double>& times_s,
                                       const std::vector<double>& periods_s, double usual_s) {
  const auto longest = std::ranges::max_element(periods_s);
  const double longest_s = *longest;
  const double before_s = times_s[static_cast<std::size_t>(longest - periods_s.begin())];
  constexpr double most_periods = 3.5;
  const auto gaps = static_cast<std::size_t>(std::ranges::count_if(
      periods_s, [&](double period_s) { return period_s > most_periods * usual_s; }));
  if (gaps == 0) return std::nullopt;
  return counted(gaps, "gap") + fmt::format(
                                    " between frames, the longest of {:.2f} s after time {:.3f} s; "
                                    "the trajectory across a gap is less certain",
                                    longest_s, before_s);
}

/// Warnings about the times of the frames of a source.
std::vector<std::string> time_warnings(const std::vector<double>& times_s) {
  const std::vector<double> periods_s = periods_between(times_s);
  if (periods_s.empty()) return {};
  std::vector<double> sorted_s = periods_s;
  const double usual_s = median(sorted_s);
  std::vector<std::string> warnings;
  for (const auto& warning : {period_warning(usual_s), gap_warning(times_s, periods_s, usual_s)}) {
    if (warning) warnings.push_back(*warning);
  }
  return warnings;
}

/// A warning about how well the frequencies agree. Empty if there is no reason for one.
std::optional<std::string> residual_warning(const ResidualSurvey& residual,
                                            const CameraErrors* camera, bool map_agrees) {
  auto mixed_up = pairing_warning(residual, map_agrees);
  return mixed_up ? mixed_up : offset_warning(residual, camera, map_agrees);
}

}  // namespace

std::vector<std::string> warnings_about(const SourceSurvey& survey, const ErrorSurvey* errors,
                                        bool map_agrees) {
  std::vector<std::string> warnings = survey.warnings;
  for (const ResidualSurvey& residual : survey.residuals) {
    const CameraErrors* camera = errors ? camera_at(*errors, residual.frequency) : nullptr;
    if (auto warning = residual_warning(residual, camera, map_agrees)) {
      warnings.push_back(*std::move(warning));
    }
  }
  std::ranges::move(time_warnings(survey.times_s), std::back_inserter(warnings));
  return warnings;
}

SourceSurvey survey_source(const SequenceReader& recording, const UnwrapOptions& unwrap) {
  std::vector<Frame> first;
  std::vector<double> times_s;
  for (int i = 0; i < *recording.frame_count(); ++i) {
    const SequenceFrameFiles& files = recording.files()[static_cast<std::size_t>(i)];
    if (files.damage.empty()) times_s.push_back(files.timestamp_s);
    if (first.size() == enough) continue;
    SourcedFrame sourced = recording.read(i);
    if (sourced.frame) first.push_back(*std::move(sourced.frame));
  }
  SourceSurvey survey = survey_of(first, recording.sensor(), unwrap);
  survey.times_s = std::move(times_s);
  return survey;
}

std::optional<SourcedFrame> WatchedSource::next() {
  std::optional<SourcedFrame> sourced = source_.next();
  if (!sourced || !sourced->frame) return sourced;
  times_s_.push_back(sourced->timestamp_s);
  if (survey_) return sourced;
  first_.push_back(*sourced->frame);
  if (first_.size() == enough) survey_first();
  return sourced;
}

void WatchedSource::survey_first() {
  survey_ = survey_of(first_, sensor(), unwrap_);
  first_.clear();
}

SourceSurvey WatchedSource::survey() {
  if (!survey_) survey_first();
  SourceSurvey survey = *survey_;
  survey.times_s = times_s_;
  return survey;
}

}  // namespace tofmap::app
