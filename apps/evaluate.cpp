// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/failure.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/recording.hpp"
#include "input/watched_source.hpp"
#include "options/options.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/result_addition.hpp"
#include "reports/evaluation_page.hpp"
#include "reports/evaluation_report.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/evaluation/method_run.hpp>
#include <tofmap/unwrap/unwrap.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct EvaluateArguments {
  RecordingArguments recording;
  std::filesystem::path out;
  CommonArguments common;
};

/// Writes a picture from above of each method's map, all in the gravity-aligned frame of the last
/// map.
void write_comparison(const std::filesystem::path& folder, const std::vector<MethodResult>& results,
                      const PictureOptions& options) {
  const RoomMap& last = *results.back().map;
  const GravityAlignedFrame frame = gravity_aligned_frame(last.surface, last.trajectory);
  for (const MethodResult& result : results) {
    write_picture(
        folder / ("map_" + result.name + ".png"),
        map_from_above(result.map->surface, result.map->trajectory, frame, options.map_size_px));
  }
}

void say_what_is_missing(const SequenceReader& source, const RecordedTruth& truth,
                         bool down_to_map) {
  if (down_to_map && truth.poses().empty()) {
    std::fprintf(
        stderr,
        "tofmap: %s has no poses in groundtruth.txt: trajectory and map errors are unknown\n",
        source.folder().c_str());
  }
  if (!truth.has_ranges()) {
    std::fprintf(stderr, "tofmap: %s has no range_truth: wrap and map errors are unknown\n",
                 source.folder().c_str());
  }
}

std::string what_is_missing(const std::vector<UnwrapMethod>& methods, std::size_t done) {
  std::vector<std::string> missing;
  for (const UnwrapMethod method : std::span(methods).subspan(done)) {
    missing.emplace_back(name_of(method));
  }
  return "these methods are missing: " + joined(missing, ", ");
}

void write_method(const OutputFolder& out, const MethodResult& result) {
  if (!result.map) return;
  write_map(out.make(result.name) / "map.ply", result.map->surface);
  write_trajectory(out.path() / result.name / "trajectory.txt", result.map->trajectory);
}

/// The methods that are named, and those that a recording with one frequency rules out.
struct MethodChoice {
  std::vector<UnwrapMethod> methods;
  std::vector<std::string> skipped;  ///< a text for each of the others, with the reason
};

/// Throws UsageError if no method is left.
MethodChoice choose_methods(const ProgramOptions& options, const SensorModel& sensor) {
  const std::vector<UnwrapMethod>& named = options.evaluation.methods;
  if (sensor.modulation.count() > 1) return {named, {}};
  MethodChoice choice;
  for (const UnwrapMethod method : named) {
    UnwrapOptions unwrap = options.pipeline.unwrap;
    unwrap.method = method;
    try {
      const Unwrapper unwrapper(sensor, unwrap);
      if (options.evaluation.down_to == EvaluatedStage::map) check_mappable(sensor, unwrap);
      choice.methods.push_back(method);
    } catch (const UsageError& error) {
      if (method == named.back() && choice.methods.empty()) throw;
      choice.skipped.push_back(fmt::format("{} was skipped: {}", name_of(method), error.what()));
    }
  }
  return choice;
}

/// The results of the methods that were to be compared.
struct Evaluated {
  Json report;
  std::vector<MethodResult> results;  ///< of the methods that succeeded
  Failures failures;                  ///< of the methods that failed
  std::size_t done = 0;               ///< number of methods that succeeded or failed
  bool interrupted = false;
};

/// Runs one method after the other. If a method fails, the others are run all the same. If all
/// fail, throws the exception of the first.
Evaluated evaluate_methods(const std::vector<UnwrapMethod>& methods, const OutputFolder& out,
                           const std::function<MethodResult(UnwrapMethod)>& run) {
  Evaluated evaluated;
  for (const UnwrapMethod method : methods) {
    evaluated.failures.attempt("method " + std::string(name_of(method)), [&] {
      MethodResult result = run(method);
      evaluated.interrupted = result.interrupted;
      if (result.interrupted) return;
      write_method(out, result);
      add_to_report(evaluated.report, result);
      evaluated.results.push_back(std::move(result));
    });
    if (evaluated.interrupted) break;
    ++evaluated.done;
  }
  if (evaluated.results.empty() && !evaluated.failures.empty()) evaluated.failures.rethrow_first();
  return evaluated;
}

void write_report(const OutputFolder& out, Evaluated& evaluated, const RecordedTruth& truth,
                  const PipelineOptions& options, const SourceSurvey& survey,
                  const std::vector<std::string>& skipped) {
  Json& report = evaluated.report;
  for (const MethodResult& result : evaluated.results) {
    add_judgement(report, result, options, all_warnings(survey, result));
  }
  report["interrupted"] = evaluated.interrupted;
  if (!evaluated.failures.empty()) report["failed"] = evaluated.failures.texts();
  if (!skipped.empty()) report["skipped"] = skipped;
  if (!truth.remarks().empty()) report["truth_left_out"] = truth.remarks();
  out.write_text("report.json", json_text(report));
}

/// The pictures and the page of the methods that succeeded.
std::vector<OptionalPart> report_parts(const std::filesystem::path& result,
                                       const EvaluationPageSubject& subject, bool interrupted,
                                       bool quiet) {
  const ProgramOptions& options = subject.options;
  const bool down_to_map = options.evaluation.down_to == EvaluatedStage::map;
  std::vector<OptionalPart> parts;
  if (!interrupted && (down_to_map || options.pictures.frames > 0)) {
    parts.push_back({"pictures", [=, &subject, &options] {
                       add_pictures(result, [&](const std::filesystem::path& folder) {
                         write_method_pictures(folder, subject.results, subject.recorded_truth,
                                               subject.recording.sensor(), options.pipeline,
                                               options.pictures, quiet);
                         if (down_to_map) {
                           write_comparison(folder, subject.results, options.pictures);
                         }
                       });
                     }});
  }
  parts.push_back({"report.html", [=, &subject] {
                     write_evaluation_page(result, subject);
                     if (quiet) return;
                     std::printf("report: %s, figures: report.json beside it\n",
                                 (result / "report.html").c_str());
                   }});
  return parts;
}

/// Reads the truth of a recording and shows progress. Throws Interrupted.
Truth truth_of(const SequenceReader& source, const RecordedTruth& recorded, bool quiet) {
  Progress progress("reading truth, frame", source.frame_count(), quiet);
  return read_truth(source, recorded, [&](int index) {
    stop_if_interrupted();
    progress.show(index);
  });
}

/// Warnings about the evaluation itself, for the page.
std::vector<std::string> page_warnings(const Evaluated& evaluated, const MethodChoice& choice) {
  std::vector<std::string> warnings = choice.skipped;
  if (evaluated.interrupted) {
    warnings.push_back("the run was interrupted; " +
                       what_is_missing(choice.methods, evaluated.done));
  }
  for (const std::string& text : evaluated.failures.texts()) {
    warnings.push_back("failed, and is missing here: " + text);
  }
  return warnings;
}

int run_evaluate(const EvaluateArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("evaluate", options);
  arguments.recording.apply(table);
  check_methods(options.evaluation);
  const bool down_to_map = options.evaluation.down_to == EvaluatedStage::map;
  const bool quiet = arguments.common.quiet;

  const SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  const MethodChoice choice = choose_methods(options, source.sensor());
  OutputFolder out(arguments.out);
  const RecordedTruth recorded(source);
  const Truth truth = down_to_map ? truth_of(source, recorded, quiet) : Truth{};
  if (!quiet) say_what_is_missing(source, recorded, down_to_map);
  if (!quiet) print_warnings(choice.skipped);
  Evaluated evaluated = evaluate_methods(choice.methods, out, [&](UnwrapMethod method) {
    Progress progress(fmt::format("method {}, frame", name_of(method)), source.frame_count(),
                      quiet);
    const MethodRun run{.method = method,
                        .options = options.pipeline,
                        .sample_frames = std::max(options.report.frames, options.pictures.frames),
                        .keep_going = [&](int done) {
                          progress.show(done);
                          return !is_interrupted();
                        }};
    return down_to_map ? run_down_to_map(run, source, recorded, truth)
                       : run_unwrapping(run, source, recorded);
  });
  const SourceSurvey survey = survey_source(source, options.pipeline.unwrap);
  write_report(out, evaluated, recorded, options.pipeline, survey, choice.skipped);
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit(evaluated.interrupted ? Completeness::interrupted : Completeness::whole);
  for (const std::string& text : evaluated.failures.texts()) {
    std::fprintf(stderr, "tofmap: %s; the other methods are in the result\n", text.c_str());
  }
  if (!evaluated.results.empty()) print_table(evaluated.report);
  if (evaluated.interrupted && !evaluated.results.empty()) {
    std::fprintf(stderr, "tofmap: interrupted; %s\n",
                 what_is_missing(choice.methods, evaluated.done).c_str());
  }
  const int status = evaluated.interrupted ? exit_status::interrupted
                                           : evaluated.failures.status_or(exit_status::done);
  if (evaluated.results.empty()) {
    std::fprintf(stderr, "tofmap: interrupted before any method was done: %s\n",
                 out.final_path().c_str());
    return status;
  }
  const EvaluationPageSubject subject{source,
                                      recorded,
                                      truth,
                                      evaluated.results,
                                      evaluated.report,
                                      survey,
                                      page_warnings(evaluated, choice),
                                      options,
                                      table.to_yaml(false)};
  const int end =
      add_to_result(out.final_path(), status,
                    report_parts(out.final_path(), subject, evaluated.interrupted, quiet));
  print_remarks(recorded);
  return end;
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
