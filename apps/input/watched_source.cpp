// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/watched_source.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/axial_depth.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>

namespace tofmap::app {
namespace {

/// The number of frames at the start of a source that are examined.
constexpr std::size_t enough = 12;

FirstFrames judge_first(const std::vector<DualFrequencyFrame>& frames, const SensorModel& sensor) {
  for (const auto& warning :
       {frequency_pair_warning(sensor.modulation), axial_depth_warning(frames, sensor)}) {
    if (warning) return {{*warning}, {}};
  }
  const std::optional<ResidualSurvey> residual = survey_residual(frames, sensor);
  const auto mixed_up = residual ? pairing_warning(*residual) : std::nullopt;
  if (mixed_up) return {{*mixed_up}, {}};
  return {{}, residual};
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

/// All warnings about a source: about its first frames, the offset between the frequencies, and the
/// times of the frames.
std::vector<std::string> all_warnings(const FirstFrames& first, const CameraErrors* camera,
                                      const std::vector<double>& times_s) {
  std::vector<std::string> warnings = first.warnings;
  const auto offset = first.residual ? offset_warning(*first.residual, camera) : std::nullopt;
  if (offset) warnings.push_back(*offset);
  std::ranges::move(time_warnings(times_s), std::back_inserter(warnings));
  return warnings;
}

}  // namespace

std::optional<SourcedFrame> WatchedSource::next() {
  std::optional<SourcedFrame> sourced = source_.next();
  if (sourced && sourced->frame) times_s_.push_back(sourced->timestamp_s);
  if (!judged_ && sourced && sourced->frame) {
    first_.push_back(*sourced->frame);
    if (first_.size() == enough) judge();
  }
  return sourced;
}

void WatchedSource::judge() {
  judged_ = judge_first(first_, sensor());
  first_.clear();
}

std::vector<std::string> WatchedSource::warnings(const CameraErrors* camera) {
  if (!judged_) judge();
  return all_warnings(*judged_, camera, times_s_);
}

std::vector<std::string> warnings_about(const SequenceReader& recording,
                                        const CameraErrors* camera) {
  std::vector<DualFrequencyFrame> first;
  std::vector<double> times_s;
  for (int i = 0; i < *recording.frame_count(); ++i) {
    const SequenceFrameFiles& files = recording.files()[static_cast<std::size_t>(i)];
    if (files.damage.empty()) times_s.push_back(files.timestamp_s);
    if (first.size() == enough) continue;
    SourcedFrame sourced = recording.read(i);
    if (sourced.frame) first.push_back(*std::move(sourced.frame));
  }
  return all_warnings(judge_first(first, recording.sensor()), camera, times_s);
}

}  // namespace tofmap::app
