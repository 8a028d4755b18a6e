// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/failure.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/map_argument.hpp"
#include "input/map_input.hpp"
#include "input/recording.hpp"
#include "input/start_place.hpp"
#include "options/options.hpp"
#include "output/map_file.hpp"
#include "output/map_result.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/result_addition.hpp"
#include "reports/consistency_report.hpp"
#include "reports/map_page.hpp"
#include "views/live_view.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/pipeline/run_store.hpp>

namespace tofmap::app {
namespace {

struct MapArguments {
  RecordingArguments recording;
  std::filesystem::path out;
  std::string method;
  std::filesystem::path onto;
  std::string start;
  bool even_if_worse = false;
  bool resume = false;
  bool pcd = false;
  bool view = false;
  CommonArguments common;
};

/// Adds report.html to a result that is in place. The page shows the truth of `recording` if that
/// is not null and has one.
void add_page(const OutputFolder& out, const FinishedMap& finished, const MapOutput& output,
              const MapInput& input, const SequenceReader* recording) {
  std::optional<RecordedTruth> truth;
  if (recording) truth.emplace(*recording);
  write_map_page(out.final_path(),
                 {input.name(), finished.map, output.recordings, output.sensor,
                  output.sample.frames(), recording, truth ? &*truth : nullptr, output.warnings,
                  finished.consistency, output.options, output.options_yaml},
                 output.choices.quiet);
  if (truth) print_remarks(*truth);
  if (!output.choices.quiet) {
    std::printf("report: %s, pictures beside it\n", (out.final_path() / "report.html").c_str());
  }
}

/// Adds pictures and page to the map that is in place, and returns the status of the command.
int add_reports(const OutputFolder& out, const FinishedMap& finished, const MapOutput& output,
                MapInput& input) {
  const RoomMap& map = finished.map;
  const ProgramOptions& options = output.options;
  const auto draw = [&](const std::filesystem::path& folder) {
    write_map_pictures(folder, map.surface, map.trajectory, options.pictures);
    if (map.interrupted) return;
    write_frame_pictures(folder, pictured_frames(output.sample.frames(), options.pictures),
                         output.sensor, options.pipeline.unwrap, output.choices.quiet);
  };
  const SequenceReader* recording = map.interrupted ? nullptr : input.recording();
  const int status =
      output.failures.status_or(map.interrupted ? exit_status::interrupted : exit_status::done);
  return add_to_result(
      out.final_path(), status,
      {{"pictures", [&] { add_pictures(out.final_path(), draw); }},
       {"report.html", [&] { add_page(out, finished, output, input, recording); }}});
}

/// Opens a window for the map. Null if --view is not given.
std::unique_ptr<LiveView> open_view(const MapArguments& arguments) {
  if (!arguments.view) return nullptr;
  return std::make_unique<LiveView>("tofmap " + arguments.recording.sequence.string());
}

void refuse_to_resume_device(const std::string& source) {
  if (!is_device_uri(source)) return;
  throw UsageError("--resume needs a recording, and " + source +
                   " is a device. 'tofmap record' records a device");
}

/// An empty sample, large enough for the page, the pictures and the consistency measures.
FrameSample sample_for(MapInput& input, const ProgramOptions& options) {
  const CameraModel& camera = input.frames().sensor().camera;
  const int wanted =
      std::max({consistency_frames(camera), options.report.frames, options.pictures.frames});
  return FrameSample(camera, wanted, input.frames().frame_count());
}

/// The state of mapping, as a phrase. Empty before the first frame.
std::string status_line(const MapRun& run, const MapInput& input) {
  if (run.frames().empty()) return "";
  const std::string losses = input.losses();
  return std::string(name_of(run.frames().back().tracking.status)) + ", " +
         std::to_string(voxel_count(run.mapper().content())) + " voxels" +
         (losses.empty() ? "" : ", " + losses);
}

/// Throws UsageError if the recording is one that the map it extends was made from: it would count
/// twice.
void refuse_repetition(const MapContent& content, const std::filesystem::path& onto) {
  if (const auto repeated = repeated_recording(content)) {
    throw UsageError(fmt::format("{}: was made from this recording ({}), which would count twice",
                                 onto.string(),
                                 content.recordings[static_cast<std::size_t>(*repeated)].source));
  }
}

/// Maps frames until the input ends or the user interrupts. Some of the frames are kept in the
/// sample of the output, and the run is stored from time to time.
void map_frames(MapRun& run, MapInput& input, MapFile& file, MapOutput& output, LiveView* view) {
  Progress progress("mapping frame", input.frames().frame_count(), output.choices.quiet);
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
    const std::filesystem::path& onto = output.choices.onto;
    if (!onto.empty()) refuse_repetition(run.mapper().content(), onto);
    file.store_if_due(run, output.sample, input, output.options.pipeline);
    const std::string status = status_line(run, input);
    progress.show(done, status);
    if (view) view->update(run, std::to_string(done) + " frames, " + status);
    return !is_interrupted();
  };
  hooks.on_frame = [&](const Frame& frame, const PreparedFrame& prepared) {
    output.sample.add(frame, prepared);
  };
  hooks.on_motion = [&](int index, const SurfaceCloud& still) {
    output.sample.drop_moving(index, still);
  };
  run.advance(input.frames(), hooks);
}

void print_how_to_resume(const RoomMap& map, const MapInput& input, const OutputFolder& out) {
  if (map.interrupted && input.is_recording() &&
      std::filesystem::exists(out.final_path() / map_file_name)) {
    std::printf("interrupted; --resume continues from %s\n", out.final_path().c_str());
  }
}

/// The file of the map: a new one or, with --resume, that of an interrupted run, if there is one,
/// or, with --onto, a copy of a finished one.
MapFile map_file(const MapArguments& arguments, OutputFolder& out) {
  if (arguments.resume) return MapFile::resumed(out, arguments.out, arguments.onto);
  tell_of_killed_run(arguments.out);
  return arguments.onto.empty() ? MapFile(out) : MapFile::extending(out, arguments.onto);
}

int run_map(const MapArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("map", options);
  arguments.recording.apply(table);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);
  const bool quiet = arguments.common.quiet;
  if (arguments.resume) {
    refuse_to_resume_device(arguments.recording.sequence.string());
  } else if (arguments.onto.empty()) {
    refuse_to_replace_grown_map(arguments.out);
  } else {
    refuse_to_replace(map_file_in(arguments.onto), arguments.out);
  }

  MapInput input(arguments.recording.sequence, options);
  if (is_interrupted()) return exit_status::interrupted;
  OutputFolder out(arguments.out);
  MapFile file = map_file(arguments, out);
  if (const auto surface = file.surface_options()) options.pipeline.map = *surface;
  MapOutput output{.choices = {.onto = arguments.onto,
                               .has_start = !arguments.start.empty(),
                               .pcd = arguments.pcd,
                               .even_if_worse = arguments.even_if_worse,
                               .resume = arguments.resume,
                               .quiet = quiet},
                   .options = options,
                   .options_yaml = table.to_yaml(false),
                   .sensor = input.frames().sensor(),
                   .sample = sample_for(input, options)};
  MapRun run(output.sensor, options.pipeline, arguments.recording.sequence.string());
  if (const MapStore* interrupted = file.to_resume()) {
    naming(arguments.out.string(), [&] {
      resume_run(*interrupted, run, output.sample, *input.recording(), options.pipeline);
    });
  }
  if (auto finished = file.to_extend()) {
    const auto start = start_place(arguments.start, *finished);
    run.go_on_with(*std::move(finished), MapUse::extend, start);
  }
  const std::unique_ptr<LiveView> view = open_view(arguments);
  FinishedMap finished;
  accompany(view.get(), [&] {
    map_frames(run, input, file, output, view.get());
    output.survey = input.survey();
    input.close();
    output.losses = input.losses();
    output.acquisition = input.acquisition();
    file.store_last(run, output.sample, input, options.pipeline);
    output.recordings = run.mapper().content().recordings;
    finished = finish_map(run, file, out, output);
  });
  if (!quiet) print_how_to_resume(finished.map, input, out);
  const int status = add_reports(out, finished, output, input);
  if (finished.is_taken_back) {
    throw InputError(arguments.onto.string() +
                     ": stays as it was, since the map would be worse with "
                     "the recording (see the verdict); " +
                     out.final_path().string() + " shows how, but has no " + map_file_name +
                     ". --even-if-worse keeps the extended map");
  }
  if (view && status == exit_status::done) view->show_result(finished.map);
  if (!input.silence().empty()) throw InputError(input.silence());
  return status;
}

}  // namespace

void add_map_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* app =
      program.add_subcommand("map", "make a map of the room from a recording or camera");
  arguments->recording.add_to(*app, "folder of the recording, OpenNI2 device or .oni file");
  app->add_option("--out", arguments->out, "folder for the result")->required();
  add_method_option(*app, arguments->method);
  CLI::Option* onto =
      app->add_option("--onto", arguments->onto,
                      "go on with a finished map, which keeps its options map.…: a folder that "
                      "'map' or 'merge' wrote, or map.db");
  add_start_option(*app, arguments->start);
  app->get_option("--start")->needs(onto);
  app->add_flag("--even-if-worse", arguments->even_if_worse,
                "keep the map that --onto extends even if its verdict is worse than before")
      ->needs(onto);
  app->add_flag("--resume", arguments->resume, "continue an interrupted run with the same --out");
  app->add_flag("--view", arguments->view, "show the map in a window as it grows");
  app->add_flag("--pcd", arguments->pcd, "also write map.pcd");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_map(*arguments); });
}

}  // namespace tofmap::app
