// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "input/recording.hpp"
#include "input/watched_source.hpp"
#include "options/options.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "reports/evaluation_page.hpp"
#include "reports/evaluation_report.hpp"
#include "runs/method_run.hpp"

#include <cstdio>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct EvaluateArguments {
  RecordingArguments recording;
  std::filesystem::path out;
  CommonArguments common;
};

/// The map of every method from above, all in the frame of the last one.
void write_comparison(const std::filesystem::path& folder, const std::vector<MethodResult>& results,
                      const PictureOptions& options) {
  const RoomMap& last = *results.back().map;
  const LevelFrame frame = level_frame(last.surface, last.trajectory);
  for (const MethodResult& result : results) {
    write_picture(
        folder / ("map_" + result.name + ".png"),
        map_from_above(result.map->surface, result.map->trajectory, frame, options.map_size_px));
  }
}

void say_what_is_missing(const SequenceReader& source, const Truth& truth, bool down_to_map) {
  if (down_to_map && truth.poses.empty()) {
    std::fprintf(stderr, "tofmap: %s has no groundtruth.txt: no trajectory or map error\n",
                 source.folder().c_str());
  }
  if (!source.range_truth(0)) {
    std::fprintf(stderr, "tofmap: %s has no range_truth: no wrap or map error\n",
                 source.folder().c_str());
  }
}

std::string what_is_missing(const std::vector<std::string>& methods,
                            const std::vector<MethodResult>& results) {
  const std::vector<std::string> missing(
      methods.begin() + static_cast<std::ptrdiff_t>(results.size()), methods.end());
  return "the run was interrupted; these methods are missing: " + joined(missing, ", ");
}

void write_method(const OutputFolder& out, const MethodResult& result) {
  if (!result.map) return;
  write_map(out.make(result.name) / "map.ply", result.map->surface);
  write_trajectory(out.path() / result.name / "trajectory.txt", result.map->trajectory);
}

/// Adds pictures and page of the methods that were asked for, as far as they have results.
void add_report(const std::filesystem::path& result, const std::vector<std::string>& methods,
                EvaluationPageSubject subject, bool quiet) {
  const ProgramOptions& options = subject.options;
  const bool interrupted = subject.results.size() < methods.size();
  const bool down_to_map = options.evaluation.down_to == "map";
  if (!interrupted && (down_to_map || options.pictures.frames > 0)) {
    add_pictures(result, [&](const std::filesystem::path& folder) {
      write_method_pictures(folder, subject.recording, methods, options.pipeline.unwrap,
                            options.pipeline.filters, options.pictures, quiet);
      if (down_to_map) write_comparison(folder, subject.results, options.pictures);
    });
  }
  if (interrupted) subject.warnings.push_back(what_is_missing(methods, subject.results));
  write_evaluation_page(result, subject, quiet);
  if (!quiet) {
    std::printf("report: %s, figures: report.json beside it\n", (result / "report.html").c_str());
  }
}

int run_evaluate(const EvaluateArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("evaluate", options);
  arguments.recording.apply(table);
  const std::vector<std::string> methods = method_names(options.evaluation);
  const bool down_to_map = options.evaluation.down_to == "map";
  const bool quiet = arguments.common.quiet;

  const SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  const Truth truth = down_to_map ? read_truth(source, quiet) : Truth{};
  if (!quiet) say_what_is_missing(source, truth, down_to_map);
  OutputFolder out(arguments.out);
  Json report;
  std::vector<MethodResult> results;
  bool interrupted = false;
  for (const std::string& method : methods) {
    MethodResult result = down_to_map
                              ? run_down_to_map(method, source, options.pipeline, truth, quiet)
                              : run_unwrapping(method, source, options.pipeline.unwrap, quiet);
    interrupted = result.interrupted;
    if (interrupted) break;
    add_to_report(report, result);
    write_method(out, result);
    results.push_back(std::move(result));
  }
  report["interrupted"] = interrupted;
  out.write_text("report.json", report.dump(1) + "\n");
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (!results.empty()) print_table(report);
  return add_to_result(
      out.final_path(), interrupted ? exit_status::interrupted : exit_status::done, [&] {
        if (results.empty()) {
          std::fprintf(stderr, "tofmap: interrupted before any method was done: %s\n",
                       out.final_path().c_str());
          return;
        }
        add_report(
            out.final_path(), methods,
            {source, truth, results, report, doubts_about(source), options, table.to_yaml(false)},
            quiet);
      });
}

}  // namespace

void add_evaluate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* app = program.add_subcommand(
      "evaluate", "compare every method, with and without unwrapping, down to the map");
  arguments->recording.add_to(*app);
  app->add_option("--out", arguments->out, "folder for the result")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_evaluate(*arguments); });
}

}  // namespace tofmap::app
