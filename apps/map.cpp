// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/failure.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/live_input.hpp"
#include "input/recording.hpp"
#include "input/sampled_frames.hpp"
#include "input/watched_source.hpp"
#include "options/options.hpp"
#include "output/frame_report.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/result_addition.hpp"
#include "reports/consistency_report.hpp"
#include "reports/map_page.hpp"
#include "runs/map_state.hpp"
#include "views/live_view.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/mapping/mesh_extraction.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/pipeline/recording_survey.hpp>

namespace tofmap::app {
namespace {

struct MapArguments {
  RecordingArguments recording;
  std::filesystem::path out;
  std::string method;
  bool resume = false;
  bool pcd = false;
  bool view = false;
  CommonArguments common;
};

void check_result(const RoomMap& map) {
  refuse_mostly_damaged(map);
  if (map.trajectory.empty() && !map.interrupted) {
    throw InputError(
        "no frame has enough surface to start a map from; is the camera covered, or "
        "the phase images mislabelled? 'tofmap info' tells more");
  }
  if (map.surface.empty() && !map.interrupted) {
    throw InputError(
        "no point was seen often and surely enough to enter the map; lower "
        "map.min_observations or raise map.max_sigma_m");
  }
}

/// What a run writes beside the map, and how.
struct MapOutput {
  const MapArguments& arguments;
  const ProgramOptions& options;
  std::string options_yaml;
  std::vector<std::string> doubts;     ///< about what was recorded, and then about the map
  nlohmann::ordered_json acquisition;  ///< of a device; else null
  const SensorModel& sensor;
  std::vector<DualFrequencyFrame> frames;  ///< some, spread over all
  Failures failures = {};                  ///< of what the map can do without
};

/// A map, and what tells whether it is right.
struct FinishedMap {
  RoomMap map;
  Consistency consistency;
};

/// What a run is for comes first: if what follows fails, this is kept.
void write_map_and_path(OutputFolder& out, const RoomMap& map) {
  write_map(out.path() / "map.ply", map.surface);
  write_trajectory(out.path() / "trajectory.txt", map.trajectory);
  write_trajectory(out.path() / "keyframes.txt", map.keyframes);
  out.keep();
}

void write_report(const OutputFolder& out, const FinishedMap& finished, const MapOutput& output) {
  nlohmann::ordered_json report;
  report["summary"] = summary_json(finished.map);
  report["camera_errors"] = errors_json(finished.map.errors);
  report["consistency"] = consistency_json(finished.consistency);
  report["doubts"] = output.doubts;
  if (!output.failures.empty()) report["failed"] = output.failures.texts();
  if (!output.acquisition.is_null()) report["acquisition"] = output.acquisition;
  for (const FrameRecord& record : finished.map.frames) {
    report["frames"].push_back(frame_json(record));
  }
  out.write_text("report.json", json_text(report));
  out.write_text("options.yaml", output.options_yaml);
}

/// Runs a step after map and path were written. If it fails, says where these are.
template <class Step>
void keeping_map(const OutputFolder& out, const Step& step) {
  try {
    step();
  } catch (const std::exception&) {
    const Failure failure = failure_of(std::current_exception());
    throw InputError(failure.message + "; map and path are kept in " + out.path().string());
  }
}

void print_summary(const RoomMap& map, const std::filesystem::path& folder) {
  std::printf("%zu of %zu frames registered, %zu keyframes, %zu map points\n",
              map.trajectory.size(), map.frames.size(), map.keyframes.size(), map.surface.size());
  if (map.damaged() > 0) std::printf("%d frames were damaged, see report.json\n", map.damaged());
  for (const std::string& remark : remarks_about(map.errors)) std::printf("%s\n", remark.c_str());
  std::printf("map: %s, mesh beside it\n", (folder / "map.ply").c_str());
}

/// What tells whether a map is right, and its mesh: a map without them is one, too.
void add_what_follows(const OutputFolder& out, FinishedMap& finished, MapOutput& output) {
  output.failures.attempt("consistency", [&] {
    finished.consistency =
        consistency_of(finished.map, output.frames, output.sensor, output.options.pipeline);
    std::ranges::move(doubts_about(finished.consistency), std::back_inserter(output.doubts));
  });
  const auto add_file = [&](const char* name, const auto& write) {
    const std::filesystem::path file = out.path() / name;
    std::error_code ignored;
    if (!output.failures.attempt(name, [&] { write(file); })) {
      std::filesystem::remove(file, ignored);
    }
  };
  const double voxel_m = output.options.pipeline.map.voxel_m;
  const MapCloud& surface = finished.map.surface;
  add_file("mesh.ply", [&](const auto& file) { write_mesh(file, extract_mesh(surface, voxel_m)); });
  if (output.arguments.pcd) {
    add_file("map.pcd", [&](const auto& file) { write_map(file, surface); });
  }
}

/// Puts the map in place; what it is doubted for comes to the doubts.
FinishedMap finish_map(MapRun& run, OutputFolder& out, MapOutput& output) {
  FinishedMap finished{run.finish(), unknown_consistency()};
  check_result(finished.map);
  write_map_and_path(out, finished.map);
  if (const auto doubt = repetition_doubt(finished.map.repeated())) output.doubts.push_back(*doubt);
  add_what_follows(out, finished, output);
  keeping_map(out, [&] { write_report(out, finished, output); });
  out.commit();
  for (const std::string& text : output.failures.texts()) {
    std::fprintf(stderr, "tofmap: %s holds the map, but without %s\n", out.final_path().c_str(),
                 text.c_str());
  }
  if (!output.arguments.common.quiet) {
    print_summary(finished.map, out.final_path());
    print_doubts(output.doubts);
  }
  return finished;
}

/// Adds report.html to a map that is in place; its truth is that of the recording, if there is one.
void add_page(const OutputFolder& out, const FinishedMap& finished, const MapOutput& output,
              const SequenceReader* recording, const std::vector<std::string>& warnings) {
  std::optional<RecordedTruth> truth;
  if (recording) truth.emplace(*recording);
  write_map_page(out.final_path(),
                 {output.arguments.recording.sequence.string(), finished.map, output.sensor,
                  output.frames, recording, truth ? &*truth : nullptr, warnings,
                  finished.consistency, output.options, output.options_yaml},
                 output.arguments.common.quiet);
  if (truth) print_remarks(*truth);
  if (!output.arguments.common.quiet) {
    std::printf("report: %s, pictures beside it\n", (out.final_path() / "report.html").c_str());
  }
}

/// The command's status, after parts were added to the map that is in place.
int status_with(const OutputFolder& out, const RoomMap& map, const MapOutput& output,
                const std::vector<OptionalPart>& parts) {
  const int status =
      map.interrupted ? exit_status::interrupted : output.failures.status_or(exit_status::done);
  return add_to_result(out.final_path(), status, parts);
}

/// A window for the map, if it is wanted.
std::unique_ptr<LiveView> open_view(const MapArguments& arguments) {
  if (!arguments.view) return nullptr;
  return std::make_unique<LiveView>("tofmap " + arguments.recording.sequence.string());
}

/// How mapping goes, in a few words.
std::string status_line(const MapRun& run) {
  if (run.frames().empty()) return "";
  return std::string(status_name(run.frames().back().tracking.status)) + ", " +
         std::to_string(run.mapper().voxel_count()) + " voxels";
}

/// Takes frames until the recording ends, or the user ends it. `remark` tells what is not told by
/// the number of frames.
void follow_camera(MapRun& run, FrameSource& source, bool quiet, LiveView* view,
                   const std::function<std::string()>& remark) {
  Progress progress("mapping frame", source.frame_count(), quiet);
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
    progress.show(done, remark());
    if (view) view->update(run, std::to_string(done) + " frames, " + status_line(run));
    return !is_interrupted();
  };
  run.advance(source, hooks);
}

int map_recording(const MapArguments& arguments, const ProgramOptions& options,
                  const OptionTable& table) {
  SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  MapRun run(source.sensor(), options.pipeline);
  if (arguments.resume) take_up_map(arguments.out, run, source, options.pipeline);
  OutputFolder out(arguments.out);
  const std::unique_ptr<LiveView> view = open_view(arguments);
  MapOutput output{
      arguments, options, table.to_yaml(false), doubts_about(source), {}, source.sensor(), {}, {}};
  FinishedMap finished;
  accompany(view.get(), [&] {
    follow_camera(run, source, arguments.common.quiet, view.get(),
                  [&] { return status_line(run); });
    if (run.is_interrupted()) write_map_state(out.path(), run, source, options.pipeline);
    output.frames = sampled_frames(source, static_cast<int>(run.frames().size()),
                                   frames_for_page(source.sensor().camera, options.report));
    finished = finish_map(run, out, output);
  });
  const RoomMap& map = finished.map;
  if (map.interrupted && !arguments.common.quiet) {
    std::printf("interrupted; --resume goes on from %s\n", out.final_path().c_str());
  }
  const auto draw = [&](const std::filesystem::path& folder) {
    write_map_pictures(folder, map.surface, map.trajectory, options.pictures);
    if (map.interrupted) return;
    write_frame_pictures(folder, source, options.pipeline.unwrap, options.pictures,
                         arguments.common.quiet);
  };
  const SequenceReader* recording = map.interrupted ? nullptr : &source;
  const int status = status_with(
      out, map, output,
      {{"pictures", [&] { add_pictures(out.final_path(), draw); }},
       {"report.html", [&] { add_page(out, finished, output, recording, output.doubts); }}});
  if (view && status == exit_status::done) view->show_result(map);
  return status;
}

int map_device(const MapArguments& arguments, const ProgramOptions& options,
               const OptionTable& table) {
  const std::string uri = arguments.recording.sequence.string();
  if (arguments.resume) {
    throw UsageError("--resume goes on with a recording; " + uri +
                     " does not come again. 'tofmap record' makes a recording of it");
  }
  OutputFolder out(arguments.out);
  const std::unique_ptr<LiveView> view = open_view(arguments);
  std::optional<LiveInput> input;
  input.emplace(uri, options, LiveInput::Wanted{});
  if (is_interrupted()) return exit_status::interrupted;
  const SensorModel sensor = input->sensor();
  SamplingSource frames(input->frames(), frames_for_page(sensor.camera, options.report));
  MapRun run(sensor, options.pipeline);
  const auto remark = [&] {
    const std::string losses = input->losses();
    return status_line(run) + (losses.empty() ? "" : ", " + losses);
  };
  MapOutput output{arguments, options, table.to_yaml(false), {}, {}, sensor, {}, {}};
  FinishedMap finished;
  accompany(view.get(), [&] {
    follow_camera(run, frames, arguments.common.quiet, view.get(), remark);
    output.doubts = input->doubts();
    output.acquisition = input->report();
    output.frames = frames.kept();
    finished = finish_map(run, out, output);
  });
  const RoomMap& map = finished.map;
  const std::string losses = input->losses();
  const std::string silence = input->silence();
  input.reset();  // its thread ends while the Ctrl-C that ends it still stands
  if (!losses.empty() && !arguments.common.quiet) {
    std::printf("not mapped: %s; see report.json\n", losses.c_str());
  }
  const auto draw = [&](const std::filesystem::path& folder) {
    write_map_pictures(folder, map.surface, map.trajectory, options.pictures);
  };
  std::vector<std::string> warnings = output.doubts;
  if (!losses.empty()) warnings.push_back("not mapped: " + losses);
  const int status =
      status_with(out, map, output,
                  {{"pictures", [&] { add_pictures(out.final_path(), draw); }},
                   {"report.html", [&] { add_page(out, finished, output, nullptr, warnings); }}});
  if (view && status == exit_status::done) view->show_result(map);
  if (!silence.empty()) throw InputError(silence);
  return status;
}

int run_map(const MapArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("map", options);
  arguments.recording.apply(table);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);
  const bool is_device = is_device_uri(arguments.recording.sequence.string());
  return is_device ? map_device(arguments, options, table)
                   : map_recording(arguments, options, table);
}

}  // namespace

void add_map_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* app =
      program.add_subcommand("map", "make a map of the room from a recording or camera");
  arguments->recording.add_to(*app, "folder of the recording, OpenNI2 device or .oni file");
  app->add_option("--out", arguments->out, "folder for the result")->required();
  add_method_option(*app, arguments->method);
  app->add_flag("--resume", arguments->resume,
                "go on where an interrupted run with this --out ended");
  app->add_flag("--view", arguments->view, "show the map in a window as it grows");
  app->add_flag("--pcd", arguments->pcd, "write map.pcd, too");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_map(*arguments); });
}

}  // namespace tofmap::app
