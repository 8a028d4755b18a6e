// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/map_argument.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/map_information.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap::app {
namespace {

struct InfoArguments {
  RecordingArguments recording;
  CommonArguments common;
};

void print_sensor(const SensorModel& sensor) {
  const CameraModel& camera = sensor.camera;
  std::printf("camera: %d x %d px, f %.1f x %.1f px, centre %.1f, %.1f px\n", camera.width_px,
              camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  const Modulation& modulation = sensor.modulation;
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    std::printf("%s: %.3f MHz, non-ambiguity range %.3f m\n", frequency_name(f).c_str(),
                modulation.frequencies_hz[f] / 1e6, modulation.wavelength_m(f));
  }
  const double combined_m = combined_range_m(modulation);
  const double noisy_m = combined_range_m(modulation, noise_tolerance_cycles);
  std::printf("combined unambiguous range: %.2f m", combined_m);
  if (noisy_m < combined_m) {
    std::printf(", and %.2f m with phase noise of %.2f cycles", noisy_m, noise_tolerance_cycles);
  }
  std::printf("\n");
  if (sensor.max_range_m > 0)
    std::printf("largest range of the scene: %.2f m\n", sensor.max_range_m);
}

/// Prints which parts of the ground truth can be used. Reads all of it.
void print_truth(const SequenceReader& source) {
  const RecordedTruth truth(source);
  bool has_ranges = false;
  double longest_m = 0;
  for (int i = 0; i < *source.frame_count() && !is_interrupted(); ++i) {
    const std::optional<ImageF> range_m = truth.range_m(i);
    if (!range_m) continue;
    has_ranges = true;
    for (const float one_m : range_m->reshaped()) longest_m = std::fmax(longest_m, one_m);
  }
  std::printf("ground truth: poses %s, ranges %s\n", truth.poses().empty() ? "no" : "yes",
              has_ranges ? "yes" : "no");
  for (const std::string& remark : truth.remarks()) std::printf("  %s\n", remark.c_str());
  const Modulation& modulation = source.sensor().modulation;
  const double combined_m = combined_range_m(modulation, noise_tolerance_cycles);
  if (modulation.count() > 1 && longest_m > combined_m &&
      source.sensor().max_range_m <= combined_m) {
    print_warnings({fmt::format(
        "true ranges reach {:.2f} m, beyond the {:.2f} m up to which the frequencies are "
        "unambiguous: surfaces beyond appear nearer by as much; with unwrap.max_range_m={:.0f}, "
        "pixels that may be either are left out",
        longest_m, combined_m, std::ceil(longest_m))});
  }
}

void print_residuals(const std::vector<ResidualSurvey>& residuals, std::size_t frequencies) {
  for (const ResidualSurvey& residual : residuals) {
    const std::string which =
        frequencies > 2 ? " of A and " + frequency_name(residual.frequency) : "";
    std::printf("inter-frequency residual%s: standard deviation %.0f mm per pixel\n", which.c_str(),
                1000 * residual.spread_m);
  }
  if (residuals.size() + 1 < frequencies) {
    std::printf(
        "inter-frequency residual: unknown, too few pixels have returns at all frequencies\n");
  }
}

void print_frames(const SequenceReader& source, const RecordingSurvey& survey) {
  const auto& files = source.files();
  std::printf("frames: %zu over %.2f s\n", files.size(),
              files.back().timestamp_s - files.front().timestamp_s);
  std::printf("pixels without a return: %.2f %%, saturated: %.2f %%\n",
              100 * survey.no_return_share, 100 * survey.saturated_share);
  print_truth(source);
  if (survey.without_amplitude > 0) {
    std::printf("frames without amplitudes: %d (noise is assumed to be uniform)\n",
                survey.without_amplitude);
  }
  print_residuals(survey.residuals, source.sensor().modulation.count());
  for (const std::string& remark : remarks_about(survey.errors)) {
    std::printf("  %s\n", remark.c_str());
  }
  std::printf("damaged frames: %zu\n", survey.damages.size());
  for (const std::string& damage : survey.damages) std::printf("  %s\n", damage.c_str());
}

RecordingSurvey read_all(const SequenceReader& source, bool quiet) {
  Progress progress("reading frame", source.frame_count(), quiet);
  return survey_recording(source, [&](int done) {
    progress.show(done);
    return !is_interrupted();
  });
}

int run_info(const InfoArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("info", options);
  arguments.recording.apply(table);
  if (is_map(arguments.recording.sequence)) {
    print_map_information(map_file_in(arguments.recording.sequence));
    return exit_status::done;
  }
  const SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  const RecordingSurvey survey = read_all(source, arguments.common.quiet);
  print_sensor(source.sensor());
  if (is_interrupted()) {
    std::printf("interrupted: all that follows is about the first %s alone\n",
                counted(static_cast<std::size_t>(survey.frames), "frame").c_str());
  }
  print_frames(source, survey);
  print_warnings(warnings_about(survey, source.sensor()));
  return is_interrupted() ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_info_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* app = program.add_subcommand(
      "info", "print what a recording or map contains, and what is wrong with it");
  arguments->recording.add_to(*app, "folder of the recording or of the map, or map.db");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_info(*arguments); });
}

}  // namespace tofmap::app
