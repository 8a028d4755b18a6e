// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/map_argument.hpp"
#include "input/map_input.hpp"
#include "input/recording.hpp"
#include "input/start_place.hpp"
#include "options/options.hpp"
#include "output/change_report.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"
#include "output/pose_printer.hpp"
#include "output/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct LocaliseArguments {
  RecordingArguments recording;
  std::filesystem::path map;
  std::filesystem::path out;
  std::string method;
  std::string start;
  bool poses = false;
  CommonArguments common;
};

/// The status of a frame that is not in the map.
std::string status_of(const FrameRecord& record) {
  const auto absence = absence_of(record);
  return absence ? std::string(name_of(*absence)) : "elsewhere";
}

Json localised_frame_json(const FrameRecord& record, const LocalisedFrame* localised) {
  Json json{{"index", record.index}, {"timestamp", record.timestamp_s}};
  if (localised == nullptr) {
    json["status"] = status_of(record);
    return json;
  }
  const Pose& pose = localised->pose.world_from_camera;
  const Eigen::Quaterniond rotation(pose.linear());
  json["status"] = "localised";
  json["position_m"] = {pose.translation().x(), pose.translation().y(), pose.translation().z()};
  json["rotation_xyzw"] = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  json["covariance"] = Json::array();
  for (const double number : localised->covariance.reshaped()) json["covariance"].push_back(number);
  return json;
}

Json report_json(const Localisation& result, const std::vector<MapRecording>& recordings) {
  Json report;
  report["summary"] = {{"frames", result.frames.size()},
                       {"localised", result.localised.size()},
                       {"interrupted", result.interrupted}};
  report["changes"] = changes_json(result.changes, recordings);
  report["frames"] = Json::array();
  auto next = result.localised.begin();
  for (const FrameRecord& record : result.frames) {
    const bool is_localised = next != result.localised.end() && next->index == record.index;
    report["frames"].push_back(localised_frame_json(record, is_localised ? &*next : nullptr));
    if (is_localised) ++next;
  }
  return report;
}

/// The largest standard deviation of the positions.
double largest_sigma_m(const Localisation& result) {
  double largest_m = 0;
  for (const LocalisedFrame& frame : result.localised) {
    largest_m = std::max(largest_m, spread_of(frame.covariance).translation_sigma_m());
  }
  return largest_m;
}

void print_summary(const Localisation& result, const std::vector<MapRecording>& recordings,
                   const OutputFolder& out) {
  std::printf("%zu of %zu frames localised, standard deviation of the position up to %.1f mm\n",
              result.localised.size(), result.frames.size(), 1000 * largest_sigma_m(result));
  print_changes(result.changes, recordings);
  std::printf("trajectory: %s, with covariances in report.json beside it\n",
              (out.final_path() / "trajectory.txt").c_str());
}

void write_result(OutputFolder& out, const Localisation& result,
                  const std::vector<MapRecording>& recordings, const std::string& options_yaml) {
  Trajectory trajectory;
  for (const LocalisedFrame& frame : result.localised) trajectory.push_back(frame.pose);
  write_trajectory(out.path() / "trajectory.txt", trajectory);
  if (!result.changes.empty()) write_changes(out.path() / changes_file_name, result.changes);
  out.write_text("report.json", json_text(report_json(result, recordings)));
  out.write_text("options.yaml", options_yaml);
  out.commit(result.interrupted ? Completeness::interrupted : Completeness::whole);
}

/// Localises frames until the input ends, the user interrupts, or the printer cannot print their
/// poses. The printer may be null. Returns whether it could print.
bool localise_frames(MapRun& run, MapInput& input, PosePrinter* printer, bool quiet) {
  Progress progress("localising frame", input.frames().frame_count(), quiet);
  bool are_read = true;
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
    const MapContent& content = run.mapper().content();
    const auto localised = localised_frames_of(content);
    if (printer != nullptr) are_read = printer->print_new(localised, content.keyframes);
    progress.show(done, done == 0           ? ""
                        : localised.empty() ? "not found yet"
                                            : std::to_string(localised.size()) + " localised");
    return are_read && !is_interrupted();
  };
  run.advance(input.frames(), hooks);
  return are_read;
}

int run_localise(const LocaliseArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("localise", options);
  arguments.recording.apply(table);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);
  const bool quiet = arguments.common.quiet;
  const std::filesystem::path map_file = map_file_in(arguments.map);
  refuse_to_replace(map_file, arguments.out);
  refuse_to_replace_grown_map(arguments.out);
  MapContent map = MapStore::open(map_file).content();
  const auto start = start_place(arguments.start, map);
  MapInput input(arguments.recording.sequence, options);
  if (is_interrupted()) return exit_status::interrupted;
  MapRun run(input.frames().sensor(), options.pipeline, arguments.recording.sequence.string());
  OutputFolder out(arguments.out);
  run.go_on_with(std::move(map), MapUse::localise, start);
  std::optional<PosePrinter> printer;
  if (arguments.poses) printer.emplace();
  const bool are_read = localise_frames(run, input, printer ? &*printer : nullptr, quiet);
  input.close();
  const Localisation result = run.finish_localised();
  if (result.localised.empty() && !result.interrupted) {
    throw InputError(told_refusal(result.nearness, result.frames, start.has_value()));
  }
  const std::vector<MapRecording>& recordings = run.mapper().content().recordings;
  write_result(out, result, recordings, table.to_yaml(false));
  if (!quiet && !arguments.poses) print_summary(result, recordings, out);
  if (!are_read) {
    throw InputError(
        "poses cannot be printed, since nobody reads them any more; those until then "
        "are in " +
        (out.final_path() / "trajectory.txt").string());
  }
  if (!input.silence().empty()) throw InputError(input.silence());
  return result.interrupted ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_localise_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<LocaliseArguments>();
  CLI::App* app = program.add_subcommand("localise", "find the path of a camera in a finished map");
  arguments->recording.add_to(*app, "folder of the recording, OpenNI2 device or .oni file");
  app->add_option("--in", arguments->map,
                  "the map: a folder that 'map' or 'merge' wrote, or map.db")
      ->required();
  app->add_option("--out", arguments->out, "folder for the result")->required();
  app->add_flag("--poses", arguments->poses,
                "print the pose of each frame as soon as it is known, as a line of a trajectory");
  add_start_option(*app, arguments->start);
  add_method_option(*app, arguments->method);
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_localise(*arguments); });
}

}  // namespace tofmap::app
