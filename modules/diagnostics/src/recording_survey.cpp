// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/recording_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <tofmap/core/frame_masks.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/axial_depth.hpp>
#include <tofmap/diagnostics/camera_warning.hpp>
#include <tofmap/diagnostics/copied_images.hpp>
#include <tofmap/diagnostics/swapped_amplitude.hpp>

namespace tofmap {
namespace {

/// The frequencies are compared in at most this many frames, spread evenly over the recording.
constexpr int compared_frames = 12;

/// With fewer returns, all pixels of an image may have the same phase by chance.
constexpr int least_returns = 100;

/// Smaller than the step between two phases of 16 bits, cycles.
constexpr float no_difference = 1e-5F;

/// Whether an image has the same phase in all pixels with a return.
bool is_constant(const ImageF& phase) {
  float least = 2;
  float most = -1;
  int returns = 0;
  for (const float value : phase.reshaped()) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
    ++returns;
  }
  return returns >= least_returns && most - least < no_difference;
}

/// Whether phases are the same in all pixels that have a return in both images. Only these pixels
/// are compared, because a copy of an image may lack returns where its amplitude is zero.
bool same_returns(const ImageF& phase, const ImageF& other) {
  if (!same_size(phase, other)) return false;
  int returns = 0;
  for (Eigen::Index i = 0; i < phase.size(); ++i) {
    const float difference = phase.data()[i] - other.data()[i];
    if (std::isnan(difference)) continue;
    if (difference != 0) return false;
    ++returns;
  }
  return returns >= least_returns;
}

/// Whether a frame has the phases of the last one at some frequencies, but not at all.
bool repeats_some(const Frame& frame, const Frame& last) {
  if (frame.frequencies() != last.frequencies()) return false;
  std::size_t same = 0;
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    same += same_returns(frame.phases[f], last.phases[f]) ? 1 : 0;
  }
  return same > 0 && same < frame.frequencies();
}

/// Pixel counts, summed over all frames.
struct PixelTotals {
  double all = 0;
  double without_return = 0;  ///< at one of the frequencies
  double saturated = 0;       ///< at one of the frequencies

  void add(const Frame& frame, double saturation_amplitude) {
    all += static_cast<double>(frame.rows() * frame.cols());
    without_return += static_cast<double>(missing_returns(frame).count());
    saturated += static_cast<double>(saturated_pixels(frame, saturation_amplitude).count());
  }

  double share(double of) const { return all > 0 ? of / all : 0; }
};

void survey_times(const std::vector<SequenceFrameFiles>& files, RecordingSurvey& survey) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (!files[i].damage.empty() || !files[i - 1].damage.empty()) continue;
    periods_s.push_back(files[i].timestamp_s - files[i - 1].timestamp_s);
    if (periods_s.back() <= survey.longest_gap_s) continue;
    survey.longest_gap_s = periods_s.back();
    survey.frame_before_gap = static_cast<int>(i) - 1;
  }
  if (!periods_s.empty()) survey.median_period_s = median(periods_s);
}

void warn_of_returns(const RecordingSurvey& survey, std::vector<std::string>& warnings) {
  constexpr double most_without_return = 0.5;
  const int whole = survey.frames - static_cast<int>(survey.damages.size());
  if (whole > 0 && survey.without_return == whole) {
    warnings.emplace_back("no pixel has a return; are the phase images mislabelled?");
  } else if (survey.without_return > 0) {
    warnings.push_back(counted(static_cast<std::size_t>(survey.without_return), "frame") +
                       " without any return; was the camera covered?");
  } else if (survey.no_return_share > most_without_return) {
    warnings.push_back(
        fmt::format("{:.0f} % of the pixels have no return; is the exposure too short, or is the "
                    "scene too far away?",
                    100 * survey.no_return_share));
  }
  constexpr double most_saturated = 0.05;
  if (survey.saturated_share > most_saturated) {
    warnings.push_back(
        fmt::format("{:.0f} % of the pixels are saturated and therefore left out; a shorter "
                    "exposure would keep them",
                    100 * survey.saturated_share));
  }
}

void warn_of_images(const RecordingSurvey& survey, std::vector<std::string>& warnings) {
  if (!survey.constant_images.empty()) {
    warnings.push_back(
        fmt::format("images with the same phase in all pixels: {}, the first of them {}; such "
                    "images are not measurements",
                    survey.constant_images.size(), survey.constant_images.front().c_str()));
  }
  if (const auto warning = repetition_warning(survey.repeated)) warnings.push_back(*warning);
  if (survey.repeated_single > 0) {
    warnings.push_back(
        counted(static_cast<std::size_t>(survey.repeated_single), "frame") +
        (survey.repeated_single == 1 ? " has" : " have") +
        " the phases of the previous frame at one frequency, and new phases at another; are "
        "files of one folder copies of each other?");
  }
}

void warn_of_times(const RecordingSurvey& survey, std::vector<std::string>& warnings) {
  if (const auto warning = period_warning(survey.median_period_s)) warnings.push_back(*warning);
  constexpr double most_periods = 5;
  if (survey.longest_gap_s > most_periods * survey.median_period_s) {
    warnings.push_back(
        fmt::format("after frame {}, nothing was recorded for {:.2f} s ({:.0f} frame periods); "
                    "tracking may be lost there",
                    survey.frame_before_gap, survey.longest_gap_s,
                    survey.longest_gap_s / survey.median_period_s));
  }
}

}  // namespace

std::optional<std::string> repetition_warning(int repeated) {
  if (repeated == 0) return std::nullopt;
  return counted(static_cast<std::size_t>(repeated), "frame") +
         (repeated == 1 ? " repeats" : " repeat") +
         " the previous frame; did the camera or its software stall?";
}

std::optional<std::string> period_warning(double median_period_s) {
  constexpr double longest_s = 10;
  constexpr double shortest_s = 1e-3;
  const bool is_of_a_camera = median_period_s >= shortest_s && median_period_s <= longest_s;
  if (is_of_a_camera || median_period_s == 0) return std::nullopt;
  return fmt::format("frames are {:.3g} s apart; are their times in seconds?", median_period_s);
}

RecordingSurvey survey_recording(const SequenceReader& recording,
                                 const std::function<bool(int)>& keep_going) {
  const SensorModel& sensor = recording.sensor();
  const int count = *recording.frame_count();
  const int every = 1 + (count - 1) / compared_frames;
  RecordingSurvey survey;
  PixelTotals totals;
  std::vector<Frame> some;
  Frame last;
  for (int i = 0; i < count; ++i) {
    if (keep_going && !keep_going(i)) break;
    ++survey.frames;
    SourcedFrame sourced = recording.read(i);
    if (!sourced.frame) {
      survey.damages.push_back(sourced.damage);
      continue;
    }
    Frame& frame = *sourced.frame;
    totals.add(frame, sensor.saturation_amplitude);
    survey.without_amplitude += frame.has_amplitude() ? 0 : 1;
    survey.without_return += is_without_return(frame) ? 1 : 0;
    const bool is_repeated = repeats(frame, last);
    survey.repeated += is_repeated ? 1 : 0;
    survey.repeated_single += !is_repeated && repeats_some(frame, last) ? 1 : 0;
    const SequenceFrameFiles& files = recording.files()[static_cast<std::size_t>(i)];
    for (std::size_t f = 0; f < frame.frequencies(); ++f) {
      if (is_constant(frame.phases[f])) survey.constant_images.push_back(files.phases[f].string());
    }
    if (i % every == 0) some.push_back(frame);
    last = std::move(frame);
  }
  survey.no_return_share = totals.share(totals.without_return);
  survey.saturated_share = totals.share(totals.saturated);
  survey_times(recording.files(), survey);
  survey.copied_images_warning = copied_images_warning(some);
  survey.swapped_amplitude_warning = swapped_amplitude_warning(some);
  survey.axial_depth_warning = axial_depth_warning(some, sensor);
  survey.residuals = survey_residuals(some, sensor);
  survey.errors = survey_errors(some, sensor);
  return survey;
}

std::vector<std::string> warnings_about(const RecordingSurvey& survey, const SensorModel& sensor) {
  std::vector<std::string> warnings;
  const auto add = [&](std::optional<std::string> warning) {
    if (warning) warnings.push_back(*std::move(warning));
  };
  add(camera_warning(sensor.camera));
  const std::optional<std::string> of_frequencies = frequency_warning(sensor);
  add(of_frequencies);
  add(order_warning(sensor.modulation));
  if (sensor.modulation.count() > 1 && sensor.max_range_m > combined_range_m(sensor.modulation)) {
    warnings.emplace_back(
        "the scene reaches farther than the combined range of these frequencies; are max_range_m "
        "and the frequencies right?");
  }
  warn_of_returns(survey, warnings);
  warn_of_images(survey, warnings);
  warn_of_times(survey, warnings);
  add(survey.copied_images_warning);
  add(survey.swapped_amplitude_warning);
  add(survey.axial_depth_warning);
  // If there is a warning about the images themselves, A and B cannot agree, and a comparison of
  // the frequencies tells nothing new.
  const bool is_comparable = !of_frequencies && !survey.axial_depth_warning &&
                             !survey.swapped_amplitude_warning && !survey.copied_images_warning &&
                             survey.constant_images.empty() && survey.repeated_single == 0;
  if (!is_comparable) return warnings;
  bool are_mixed_up = false;
  for (const ResidualSurvey& residual : survey.residuals) {
    const std::optional<std::string> mixed_up = pairing_warning(residual);
    add(mixed_up);
    are_mixed_up = are_mixed_up || mixed_up;
  }
  if (are_mixed_up) return warnings;
  for (const ResidualSurvey& residual : survey.residuals) {
    add(offset_warning(residual, camera_at(survey.errors, residual.frequency)));
  }
  for (std::string& warning : warnings_about(survey.errors)) warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace tofmap
