// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "recording.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::app {
namespace {

struct InfoArguments {
  RecordingArguments recording;
  CommonArguments common;
};

/// What a look at every frame tells.
struct FrameSurvey {
  int damaged = 0;
  int without_amplitude = 0;
  double pixels = 0;
  double without_return = 0;
  std::vector<std::string> damages;
};

FrameSurvey survey_frames(const SequenceReader& source) {
  FrameSurvey survey;
  for (int i = 0; i < *source.frame_count() && !is_interrupted(); ++i) {
    const SourcedFrame sourced = source.read(i);
    if (!sourced.frame) {
      ++survey.damaged;
      survey.damages.push_back(sourced.damage);
      continue;
    }
    const DualFrequencyFrame& frame = *sourced.frame;
    survey.without_amplitude += frame.has_amplitude() ? 0 : 1;
    survey.pixels += static_cast<double>(frame.phase_a.size());
    survey.without_return +=
        static_cast<double>((frame.phase_a.isNaN() || frame.phase_b.isNaN()).count());
  }
  return survey;
}

void print_sensor(const SensorModel& sensor) {
  const CameraModel& camera = sensor.camera;
  std::printf("camera: %d x %d px, f %.1f x %.1f px, centre %.1f, %.1f px\n", camera.width_px,
              camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  const Modulation& modulation = sensor.modulation;
  std::printf("A: %.3f MHz, non-ambiguity range %.3f m\n", modulation.frequency_a_hz / 1e6,
              modulation.wavelength_a_m());
  std::printf("B: %.3f MHz, non-ambiguity range %.3f m\n", modulation.frequency_b_hz / 1e6,
              modulation.wavelength_b_m());
  std::printf("combined unambiguous range: %.2f m\n", combined_range_m(modulation));
  if (sensor.max_range_m > 0) std::printf("the scene reaches to: %.2f m\n", sensor.max_range_m);
}

void print_frames(const SequenceReader& source, const FrameSurvey& survey) {
  const auto& files = source.files();
  std::printf("frames: %zu over %.2f s\n", files.size(),
              files.back().timestamp_s - files.front().timestamp_s);
  if (survey.pixels > 0) {
    std::printf("pixels without a return: %.2f %%\n", 100 * survey.without_return / survey.pixels);
  }
  const bool has_poses = !source.ground_truth().empty();
  std::printf("ground truth: poses %s, ranges %s\n", has_poses ? "yes" : "no",
              source.range_truth(0) ? "yes" : "no");
  if (survey.without_amplitude > 0) {
    std::printf("frames without amplitudes: %d (noise is taken as uniform)\n",
                survey.without_amplitude);
  }
  std::printf("damaged frames: %d\n", survey.damaged);
  for (const std::string& damage : survey.damages) std::printf("  %s\n", damage.c_str());
}

/// What unwrapping cannot make good.
void print_doubts(const SensorModel& sensor, const FrameSurvey& survey) {
  if (sensor.max_range_m > combined_range_m(sensor.modulation)) {
    std::printf(
        "doubtful: the scene reaches farther than this pair of frequencies can tell apart; "
        "are they right?\n");
  }
  if (survey.pixels > 0 && survey.without_return == survey.pixels) {
    std::printf("doubtful: no pixel has a return; are the phase images mislabelled?\n");
  }
}

int run_info(const InfoArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("info", options);
  arguments.recording.apply(table);
  const SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  const FrameSurvey survey = survey_frames(source);
  print_sensor(source.sensor());
  print_frames(source, survey);
  print_doubts(source.sensor(), survey);
  return is_interrupted() ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_info_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* app = program.add_subcommand("info", "tell what is in a recording, and what is wrong");
  arguments->recording.add_to(*app);
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_info(*arguments); });
}

}  // namespace tofmap::app
