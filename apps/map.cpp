// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/failure.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/map_input.hpp"
#include "input/recording.hpp"
#include "input/start_place.hpp"
#include "options/options.hpp"
#include "output/change_report.hpp"
#include "output/coverage.hpp"
#include "output/frame_report.hpp"
#include "output/json_text.hpp"
#include "output/map_file.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/refusal.hpp"
#include "output/result_addition.hpp"
#include "reports/consistency_report.hpp"
#include "reports/map_page.hpp"
#include "views/live_view.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>
#include <tofmap/mapping/mesh_extraction.hpp>
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

void check_result(const RoomMap& map) {
  refuse_mostly_damaged(map);
  if (map.trajectory.empty() && !map.interrupted) {
    throw InputError(
        "no frame has enough surface to start a map from; is the camera covered, or are the phase "
        "images mislabelled? 'tofmap info' prints more about the recording");
  }
  if (map.surface.empty() && !map.interrupted) {
    const auto warning = repetition_warning(map.repeated());
    throw InputError(
        "no point was seen often enough, and with little enough uncertainty, to enter the map; "
        "lower map.min_observations or raise map.max_sigma_m" +
        (warning ? ". " + *warning : ""));
  }
}

/// Throws InputError if no frame was found in the map that is extended.
void refuse_another_place(const RoomMap& map) {
  if (!map.localised || *map.localised > 0) return;
  throw InputError(told_refusal(map.nearness, map.frames.size()));
}

/// What is needed to write the result of a run besides the map itself.
struct MapOutput {
  const MapArguments& arguments;
  const ProgramOptions& options;
  std::string options_yaml;
  SensorModel sensor;
  FrameSample sample;
  std::vector<MapRecording> recordings = {};  ///< that the map was made from
  SourceSurvey survey = {};                   ///< of the recording or device
  std::vector<std::string> warnings = {};     ///< about the recording, then about the map
  nlohmann::ordered_json acquisition = {};    ///< report of a device; null for a recording
  std::string losses = {};                    ///< MapInput::losses()
  Failures failures = {};                     ///< failures of optional parts
};

/// A map, its consistency measures, and the verdict on it without ground truth.
struct FinishedMap {
  RoomMap map;
  Consistency consistency;
  Judgement judgement = {};
  bool is_taken_back = false;  ///< the map that was extended stays as it was
};

/// Whether an extended map is worse than the map before, and no loop has shown that this was wrong.
bool is_to_be_taken_back(const FinishedMap& finished, const MapFile& file,
                         const MapArguments& arguments) {
  const auto before = file.verdict_before();
  return before && finished.judgement.verdict > *before && !finished.map.interrupted &&
         !finished.map.has_moved_map && !arguments.even_if_worse;
}

/// Writes the map and the trajectories, which are kept even if a later step fails.
void write_map_and_path(OutputFolder& out, const RoomMap& map) {
  write_map(out.path() / "map.ply", map.surface);
  write_trajectory(out.path() / "trajectory.txt", map.trajectory);
  write_trajectory(out.path() / "keyframes.txt", map.keyframes);
  for (std::size_t i = 0; i < map.separate_maps.size(); ++i) {
    const SeparateMap& one = map.separate_maps[i];
    const SeparateMapFiles files = files_of_separate_map(i);
    write_map(out.path() / files.map, one.surface);
    write_trajectory(out.path() / files.trajectory, one.trajectory);
    write_trajectory(out.path() / files.keyframes, one.keyframes);
  }
  out.keep();
}

void write_report(const OutputFolder& out, const FinishedMap& finished, const MapOutput& output) {
  nlohmann::ordered_json report;
  report["judgement"] = judgement_json(finished.judgement);
  report["summary"] = summary_json(finished.map);
  report["camera_errors"] = errors_json(finished.map.errors);
  report["consistency"] = consistency_json(finished.consistency);
  report["changes"] = changes_json(finished.map.changes, output.recordings);
  report["warnings"] = output.warnings;
  if (!output.failures.empty()) report["failed"] = output.failures.texts();
  if (!output.acquisition.is_null()) report["acquisition"] = output.acquisition;
  for (const FrameRecord& record : finished.map.frames) {
    report["frames"].push_back(frame_json(record));
  }
  out.write_text("report.json", json_text(report));
  out.write_text("options.yaml", output.options_yaml);
}

/// Runs a step after the map and the path were written. If the step fails, throws InputError with a
/// message that says where they are kept.
template <class Step>
void keeping_map(const OutputFolder& out, const Step& step) {
  try {
    step();
  } catch (const std::exception&) {
    const Failure failure = failure_of(std::current_exception());
    throw InputError(failure.message + "; map and path are kept in " + out.path().string());
  }
}

void print_separate_maps(const RoomMap& map, const std::filesystem::path& folder) {
  if (map.separate_maps.empty()) return;
  constexpr std::size_t most_named = 5;
  const std::size_t count = map.separate_maps.size();
  std::printf("tracking was lost, and %s could not be joined with map.ply:\n",
              counted(count, "separate map").c_str());
  for (std::size_t i = 0; i < std::min(count, most_named); ++i) {
    std::printf("  %s: %s (%s), begun %s\n", files_of_separate_map(i).map.c_str(),
                counted(map.separate_maps[i].trajectory.size(), "frame").c_str(),
                told_extent(map, i).c_str(), told_beginning(map, i).c_str());
  }
  if (count > most_named) std::printf("  and %zu more; see report.html\n", count - most_named);
  if (map.surface.empty() || map.separate_maps.front().surface.empty()) return;
  std::printf("  to join maps that show the same place, try: tofmap register %s %s --out DIR\n",
              (folder / "map.ply").c_str(), (folder / files_of_separate_map(0).map).c_str());
}

void print_summary(const RoomMap& map, const std::filesystem::path& folder) {
  std::printf("%zu of %zu frames registered, %s, %zu map points\n", map.trajectory.size(),
              map.frames.size(), counted(map.keyframes.size(), "keyframe").c_str(),
              map.surface.size());
  print_separate_maps(map, folder);
  for (const AbsentFrames& absent : absent_frames(map)) {
    std::printf("%s in no map, %s: %s\n", counted(absent.indices.size(), "frame").c_str(),
                absent.why.c_str(), told_indices(absent.indices).c_str());
  }
  for (const std::string& remark : remarks_about(map.errors)) std::printf("%s\n", remark.c_str());
  const bool has_mesh = std::filesystem::exists(folder / "mesh.ply");
  std::printf("map: %s%s\n", (folder / "map.ply").c_str(), has_mesh ? ", mesh beside it" : "");
}

/// Adds consistency measures, mesh and map.pcd. A failure of one of them is stored, and the others
/// are still added.
void add_what_follows(const OutputFolder& out, FinishedMap& finished, MapOutput& output) {
  const auto add_file = [&](const char* name, const auto& write) {
    const std::filesystem::path file = out.path() / name;
    std::error_code ignored;
    if (!output.failures.attempt(name, [&] { write(file); })) {
      std::filesystem::remove(file, ignored);
    }
  };
  output.failures.attempt("consistency", [&] {
    finished.consistency = consistency_of(finished.map, output.sample, output.sensor,
                                          output.options.pipeline.unwrap.method);
  });
  const double voxel_m = output.options.pipeline.map.voxel_m;
  const MapCloud& surface = finished.map.surface;
  add_file("mesh.ply", [&](const auto& file) { write_mesh(file, extract_mesh(surface, voxel_m)); });
  if (!finished.map.changes.empty()) {
    add_file(changes_file_name,
             [&](const auto& file) { write_changes(file, finished.map.changes); });
  }
  if (output.arguments.pcd) {
    add_file("map.pcd", [&](const auto& file) { write_map(file, surface); });
  }
}

/// Finishes the map, writes the result and moves it into place. Sets the warnings.
FinishedMap finish_map(MapRun& run, MapFile& file, OutputFolder& out, MapOutput& output) {
  FinishedMap finished{.map = run.finish(), .consistency = unknown_consistency()};
  check_result(finished.map);
  refuse_another_place(finished.map);
  write_map_and_path(out, finished.map);
  add_what_follows(out, finished, output);
  output.warnings = all_warnings(output.survey, finished.map, finished.consistency);
  if (!output.losses.empty()) output.warnings.push_back("not mapped: " + output.losses);
  finished.judgement = judge(
      evidence_of(finished.map, output.options.pipeline, finished.consistency, output.warnings));
  finished.is_taken_back = is_to_be_taken_back(finished, file, output.arguments);
  if (finished.is_taken_back) file.discard();
  keeping_map(out, [&] { write_report(out, finished, output); });
  if (!finished.is_taken_back) {
    // Last, since a run that is killed afterwards cannot be resumed.
    run.note_verdict(finished.judgement.verdict);
    const std::size_t failures = output.failures.texts().size();
    output.failures.attempt(map_file_name, [&] { file.complete(run, finished.map.interrupted); });
    if (output.failures.texts().size() > failures) {
      keeping_map(out, [&] { write_report(out, finished, output); });
    }
  }
  const auto interrupted =
      output.arguments.resume ? Completeness::resumable : Completeness::interrupted;
  out.commit(finished.map.interrupted ? interrupted
             : finished.is_taken_back ? Completeness::taken_back
                                      : Completeness::whole);
  for (const std::string& text : output.failures.texts()) {
    std::fprintf(stderr, "tofmap: %s holds the map, but without %s\n", out.final_path().c_str(),
                 text.c_str());
  }
  if (!output.arguments.common.quiet) {
    print_summary(finished.map, out.final_path());
    print_changes(finished.map.changes, output.recordings);
    print_warnings(output.warnings);
    const Judgement& judgement = finished.judgement;
    std::printf("verdict: %s%s\n", std::string(sentence_of(judgement.verdict)).c_str(),
                told_reasons(judgement).c_str());
  }
  return finished;
}

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
                 output.arguments.common.quiet);
  if (truth) print_remarks(*truth);
  if (!output.arguments.common.quiet) {
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
                         output.sensor, options.pipeline.unwrap, output.arguments.common.quiet);
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

/// Maps frames until the input ends or the user interrupts. Some of the frames are kept in the
/// sample of the output, and the run is stored from time to time.
void map_frames(MapRun& run, MapInput& input, MapFile& file, MapOutput& output, LiveView* view) {
  Progress progress("mapping frame", input.frames().frame_count(), output.arguments.common.quiet);
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
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
  if (arguments.resume) refuse_to_resume_device(arguments.recording.sequence.string());

  MapInput input(arguments.recording.sequence, options);
  if (is_interrupted()) return exit_status::interrupted;
  OutputFolder out(arguments.out);
  MapFile file = map_file(arguments, out);
  if (const auto surface = file.surface_options()) options.pipeline.map = *surface;
  MapOutput output{.arguments = arguments,
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
  app->add_option("--onto", arguments->onto,
                  "go on with a finished map, which keeps its options map.…: a folder that 'map' "
                  "wrote, or map.db");
  add_start_option(*app, arguments->start);
  app->add_flag("--even-if-worse", arguments->even_if_worse,
                "keep the map that --onto extends even if its verdict is worse than before");
  app->add_flag("--resume", arguments->resume, "continue an interrupted run with the same --out");
  app->add_flag("--view", arguments->view, "show the map in a window as it grows");
  app->add_flag("--pcd", arguments->pcd, "also write map.pcd");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_map(*arguments); });
}

}  // namespace tofmap::app
