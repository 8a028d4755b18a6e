// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "frame_report.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/evaluation/range_score.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array methods{"none", "pixel", "single", "jump"};

struct EvaluateArguments {
  std::filesystem::path sequence;
  std::filesystem::path out;
  CommonArguments common;
};

/// What is known of the truth; any part may be missing.
struct Truth {
  Trajectory poses;
  ReferenceSurface surface;
};

/// One method from phases to map, and how right it is.
struct MethodResult {
  std::string name;
  RoomMap map;
  std::vector<RangeScore> ranges;  ///< of the frames with true ranges
  std::optional<TrajectoryScore> trajectory;
  std::optional<MapScore> surface;
};

/// The true pose of a frame; nothing if none is within half a frame of a slow camera.
std::optional<Pose> true_pose(const Trajectory& poses, double timestamp_s) {
  constexpr double max_gap_s = 0.02;
  for (const StampedPose& pose : poses) {
    if (std::abs(pose.timestamp_s - timestamp_s) < max_gap_s) return pose.world_from_camera;
  }
  return std::nullopt;
}

Truth read_truth(const SequenceReader& source, const PixelRays& rays) {
  Truth truth;
  truth.poses = source.ground_truth();
  constexpr int every = 3;  // neighbouring frames see the same surface
  for (int i = 0; i < *source.frame_count(); i += every) {
    const auto pose =
        true_pose(truth.poses, source.files()[static_cast<std::size_t>(i)].timestamp_s);
    const auto ranges = source.range_truth(i);
    if (pose && ranges) truth.surface.add(*ranges, rays, *pose);
  }
  return truth;
}

MethodResult run_method(const std::string& name, const std::filesystem::path& sequence,
                        PipelineOptions options, const Truth& truth, bool quiet) {
  MethodResult result;
  result.name = name;
  options.unwrap.method = name;
  SequenceReader source(sequence);
  const double wavelength_m = source.sensor().modulation.wavelength_a_m();
  Progress progress("method " + name + ", frame", source.frame_count(), quiet);
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
    progress.show(done);
    return !is_interrupted();
  };
  hooks.on_frame = [&](const PreparedFrame& frame) {
    const auto ranges = source.range_truth(frame.index);
    if (!ranges) return;
    result.ranges.push_back(score_ranges(frame.unwrapped.image, *ranges, wavelength_m));
  };
  result.map = map_room(source, options, hooks);
  result.trajectory = score_trajectory(result.map.trajectory, truth.poses);
  if (result.trajectory && !truth.surface.points().empty()) {
    result.surface =
        score_map(result.map.surface, result.trajectory->truth_from_estimate, truth.surface);
  }
  return result;
}

/// JSON has no NaN: what could not be had is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void add_to_report(Json& report, const MethodResult& result) {
  const Json summary = summary_json(result.map);
  Json& unwrapping = report["unwrapping"][result.name];
  if (!result.ranges.empty()) {
    const RangeScore mean = mean_score(result.ranges);
    unwrapping["wrong_wrap_percent"] = number(mean.wrong_wrap_percent);
    unwrapping["coverage_percent"] = number(mean.coverage_percent);
    unwrapping["range_rmse_m"] = number(mean.range_rmse_m);
  }
  unwrapping["milliseconds_per_frame"] = summary["milliseconds"]["unwrap"];
  Json& trajectory = report["trajectory"][result.name];
  trajectory["registered_frames"] = result.map.trajectory.size();
  if (result.trajectory) {
    trajectory["ate_rmse_m"] = number(result.trajectory->ate_rmse_m);
    trajectory["ate_max_m"] = number(result.trajectory->ate_max_m);
    trajectory["rpe_rmse_m_per_m"] = number(result.trajectory->rpe_rmse_m_per_m);
    trajectory["rpe_rmse_deg_per_m"] = number(result.trajectory->rpe_rmse_deg_per_m);
  }
  Json& map = report["map"][result.name];
  map["points"] = result.map.surface.size();
  if (result.surface) {
    map["accuracy_m"] = number(result.surface->accuracy_m);
    map["far_percent"] = number(result.surface->far_percent);
    map["completeness_percent"] = number(result.surface->completeness_percent);
  }
  map["milliseconds_per_frame"] = summary["milliseconds_per_frame"];
}

std::string cell(const Json& report, const char* group, const std::string& method,
                 const char* metric, const char* format) {
  const Json& values = report[group][method];
  if (!values.contains(metric) || !values[metric].is_number()) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, values[metric].get<double>());
  return text.data();
}

void print_table(const Json& report) {
  std::printf("%-8s %10s %10s %9s %9s %10s %10s %12s %10s\n", "method", "wrong", "range", "frames",
              "ATE", "RPE", "map", "map seen", "time");
  std::printf("%-8s %10s %10s %9s %9s %10s %10s %12s %10s\n", "", "wraps %", "RMSE m", "placed",
              "RMSE m", "m per m", "error m", "%", "ms/frame");
  for (const auto& [method, values] : report["unwrapping"].items()) {
    std::printf("%-8s %10s %10s %9s %9s %10s %10s %12s %10s\n", method.c_str(),
                cell(report, "unwrapping", method, "wrong_wrap_percent", "%.3f").c_str(),
                cell(report, "unwrapping", method, "range_rmse_m", "%.3f").c_str(),
                cell(report, "trajectory", method, "registered_frames", "%.0f").c_str(),
                cell(report, "trajectory", method, "ate_rmse_m", "%.4f").c_str(),
                cell(report, "trajectory", method, "rpe_rmse_m_per_m", "%.4f").c_str(),
                cell(report, "map", method, "accuracy_m", "%.4f").c_str(),
                cell(report, "map", method, "completeness_percent", "%.1f").c_str(),
                cell(report, "map", method, "milliseconds_per_frame", "%.1f").c_str());
  }
}

/// The map of every method from above, all in the frame of the last one: the paper's.
void write_comparison(const std::filesystem::path& folder, const std::vector<MethodResult>& results,
                      const PictureOptions& options) {
  if (results.empty()) return;
  const RoomMap& best = results.back().map;
  const LevelFrame frame = level_frame(best.surface, best.trajectory);
  for (const MethodResult& result : results) {
    write_picture(
        folder / ("map_" + result.name + ".png"),
        map_from_above(result.map.surface, result.map.trajectory, frame, options.map_size_px));
  }
}

void say_what_is_missing(const SequenceReader& source, const Truth& truth) {
  if (truth.poses.empty()) {
    std::fprintf(stderr, "tofmap: %s has no groundtruth.txt: no trajectory or map error\n",
                 source.folder().c_str());
  }
  if (!source.range_truth(0)) {
    std::fprintf(stderr, "tofmap: %s has no range_truth: no wrap or map error\n",
                 source.folder().c_str());
  }
}

int run_evaluate(const EvaluateArguments& arguments) {
  ProgramOptions options;
  const OptionTable table = arguments.common.resolve("evaluate", options);

  const SequenceReader source(arguments.sequence);
  const Truth truth = read_truth(source, pixel_rays(source.sensor().camera));
  if (!arguments.common.quiet) say_what_is_missing(source, truth);
  OutputFolder out(arguments.out);
  Json report;
  std::vector<MethodResult> results;
  for (const char* method : methods) {
    MethodResult result =
        run_method(method, arguments.sequence, options.pipeline, truth, arguments.common.quiet);
    if (result.map.interrupted) break;
    refuse_mostly_damaged(result.map);
    add_to_report(report, result);
    write_map(out.make(method) / "map.ply", result.map.surface);
    write_trajectory(out.path() / method / "trajectory.txt", result.map.trajectory);
    results.push_back(std::move(result));
  }
  try_to_draw([&] { write_comparison(out.make("pictures"), results, options.pictures); });
  const bool interrupted = is_interrupted();
  report["interrupted"] = interrupted;
  out.write_text("report.json", report.dump(1) + "\n");
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (report.contains("unwrapping")) print_table(report);
  if (!arguments.common.quiet) {
    std::printf("report: %s\n", (out.final_path() / "report.json").c_str());
  }
  return interrupted ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_evaluate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* app = program.add_subcommand(
      "evaluate", "compare every method, with and without unwrapping, down to the map");
  app->add_option("SEQ", arguments->sequence, "folder of the recording")->required();
  app->add_option("--out", arguments->out, "folder for the result")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_evaluate(*arguments); });
}

}  // namespace tofmap::app
