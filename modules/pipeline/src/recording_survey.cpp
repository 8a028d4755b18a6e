// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/recording_survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <tofmap/acquisition/phase_error_fit.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

/// Frames that are unwrapped, spread evenly, and pixels of each that are looked at.
constexpr int beat_frames = 12;
constexpr int beat_stride = 3;
constexpr std::size_t least_beat_pixels = 300;

/// Images with fewer returns may be of one range.
constexpr int least_returns = 100;

/// Below what phases of 16 bits can differ by.
constexpr float no_difference = 1e-5F;

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

bool is_same(const ImageF& one, const ImageF& other) {
  return same_size(one, other) && (one == other || (one.isNaN() && other.isNaN())).all();
}

bool is_without_return(const DualFrequencyFrame& frame) {
  return (frame.phase_a.isNaN() || frame.phase_b.isNaN()).all();
}

/// Pixels of all frames.
struct PixelTotals {
  double all = 0;
  double without_return = 0;  ///< at either frequency
  double saturated = 0;       ///< at either frequency

  void add(const DualFrequencyFrame& frame, double saturation_amplitude) {
    all += static_cast<double>(frame.phase_a.size());
    without_return += static_cast<double>((frame.phase_a.isNaN() || frame.phase_b.isNaN()).count());
    if (!frame.has_amplitude() || saturation_amplitude <= 0) return;
    const auto limit = static_cast<float>(saturation_amplitude);
    saturated +=
        static_cast<double>((frame.amplitude_a >= limit || frame.amplitude_b >= limit).count());
  }

  double share(double of) const { return all > 0 ? of / all : 0; }
};

/// By how much A measures more than B, in single pixels.
std::vector<float> differences_m(const std::vector<DualFrequencyFrame>& frames,
                                 const SensorModel& sensor) {
  UnwrapOptions options;
  options.method = "pixel";
  Unwrapper unwrapper(sensor, options);
  std::vector<RangePair> pairs;
  for (const DualFrequencyFrame& frame : frames) {
    const ImageF range_m = unwrapper.unwrap(frame).image.range_m;
    append_range_pairs(frame, sensor.modulation, range_m, 0, beat_stride, pairs);
  }
  std::vector<float> differences;
  for (const RangePair& pair : pairs) differences.push_back(pair.a_m - pair.b_m);
  return differences;
}

double spread_of(std::vector<float> values, float middle) {
  for (float& value : values) value = std::abs(value - middle);
  return sigma_of_median_deviation * double{median(values)};
}

std::optional<BeatSurvey> survey_beat(const std::vector<DualFrequencyFrame>& frames,
                                      const SensorModel& sensor) {
  std::vector<float> differences = differences_m(frames, sensor);
  if (differences.size() < least_beat_pixels) return std::nullopt;
  BeatSurvey survey;
  const float middle = median(differences);
  survey.offset_m = double{middle};
  survey.spread_m = spread_of(differences, middle);
  SensorModel swapped = sensor;
  std::swap(swapped.modulation.frequency_a_hz, swapped.modulation.frequency_b_hz);
  std::vector<float> of_swapped = differences_m(frames, swapped);
  survey.swapped_spread_m = spread_of(of_swapped, median(of_swapped));
  survey.ambiguity_m =
      std::abs(sensor.modulation.wavelength_a_m() - sensor.modulation.wavelength_b_m());
  return survey;
}

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

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

void doubt_returns(const RecordingSurvey& survey, std::vector<std::string>& doubts) {
  constexpr double most_without_return = 0.5;
  const int whole = survey.frames - static_cast<int>(survey.damages.size());
  if (whole > 0 && survey.without_return == whole) {
    doubts.emplace_back("no pixel has a return; are the phase images mislabelled?");
  } else if (survey.without_return > 0) {
    doubts.push_back(
        text("%d frames have no return at all; was the camera covered?", survey.without_return));
  } else if (survey.no_return_share > most_without_return) {
    doubts.push_back(
        text("%.0f %% of the pixels have no return; is the exposure too short, or the "
             "scene out of reach?",
             100 * survey.no_return_share));
  }
  constexpr double most_saturated = 0.05;
  if (survey.saturated_share > most_saturated) {
    doubts.push_back(
        text("%.0f %% of the pixels are saturated, and left out; a shorter exposure "
             "would keep them",
             100 * survey.saturated_share));
  }
}

void doubt_images(const RecordingSurvey& survey, std::vector<std::string>& doubts) {
  if (!survey.constant_images.empty()) {
    doubts.push_back(
        text("%zu images hold one phase everywhere, %s the first; they are no "
             "measurement",
             survey.constant_images.size(), survey.constant_images.front().c_str()));
  }
  if (survey.repeated > 0) {
    doubts.push_back(
        text("%d frames repeat the one before; did the camera stand still in its software?",
             survey.repeated));
  }
}

void doubt_times(const RecordingSurvey& survey, std::vector<std::string>& doubts) {
  constexpr double most_periods = 5;
  if (survey.longest_gap_s > most_periods * survey.median_period_s) {
    doubts.push_back(
        text("after frame %d nothing was recorded for %.2f s, %.0f frame periods; the "
             "camera may be lost there",
             survey.frame_before_gap, survey.longest_gap_s,
             survey.longest_gap_s / survey.median_period_s));
  }
}

void doubt_beat(const BeatSurvey& beat, std::vector<std::string>& doubts) {
  constexpr double telling_ratio = 0.5;
  if (beat.swapped_spread_m < telling_ratio * beat.spread_m) {
    doubts.push_back(text(
        "both frequencies agree within %.0f mm if they are swapped, and within %.0f mm as they "
        "are; are frequency_a_hz and frequency_b_hz mixed up, or the folders of A and B?",
        1000 * beat.swapped_spread_m, 1000 * beat.spread_m));
    return;
  }
  constexpr double most_offset_m = 0.02;  // motion between both images makes some millimetres
  if (std::abs(beat.offset_m) < most_offset_m) return;
  doubts.push_back(text(
      "A measures %+.0f mm more than B (or that and a multiple of %.0f mm): the phase offset of "
      "one of them seems wrong; 'tofmap calibrate' against known ranges finds both",
      1000 * beat.offset_m, 1000 * beat.ambiguity_m));
}

}  // namespace

RecordingSurvey survey_recording(const SequenceReader& recording,
                                 const std::function<bool()>& keep_going) {
  const SensorModel& sensor = recording.sensor();
  const int count = *recording.frame_count();
  const int every = 1 + (count - 1) / beat_frames;
  RecordingSurvey survey;
  PixelTotals totals;
  std::vector<DualFrequencyFrame> some;
  ImageF last_phase;
  for (int i = 0; i < count; ++i) {
    if (keep_going && !keep_going()) break;
    ++survey.frames;
    SourcedFrame sourced = recording.read(i);
    if (!sourced.frame) {
      survey.damages.push_back(sourced.damage);
      continue;
    }
    DualFrequencyFrame& frame = *sourced.frame;
    totals.add(frame, sensor.saturation_amplitude);
    survey.without_amplitude += frame.has_amplitude() ? 0 : 1;
    survey.without_return += is_without_return(frame) ? 1 : 0;
    survey.repeated += is_same(frame.phase_a, last_phase) ? 1 : 0;
    const SequenceFrameFiles& files = recording.files()[static_cast<std::size_t>(i)];
    if (is_constant(frame.phase_a)) survey.constant_images.push_back(files.phase_a.string());
    if (is_constant(frame.phase_b)) survey.constant_images.push_back(files.phase_b.string());
    last_phase = frame.phase_a;
    if (i % every == 0) some.push_back(std::move(frame));
  }
  survey.no_return_share = totals.share(totals.without_return);
  survey.saturated_share = totals.share(totals.saturated);
  survey_times(recording.files(), survey);
  survey.beat = survey_beat(some, sensor);
  return survey;
}

std::vector<std::string> doubts_about(const RecordingSurvey& survey, const SensorModel& sensor) {
  std::vector<std::string> doubts;
  if (sensor.max_range_m > combined_range_m(sensor.modulation)) {
    doubts.emplace_back(
        "the scene reaches farther than this pair of frequencies can tell apart; are they right?");
  }
  doubt_returns(survey, doubts);
  doubt_images(survey, doubts);
  doubt_times(survey, doubts);
  if (survey.beat) doubt_beat(*survey.beat, doubts);
  return doubts;
}

}  // namespace tofmap
