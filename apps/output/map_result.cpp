// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/map_result.hpp"

#include "input/recording.hpp"
#include "output/change_report.hpp"
#include "output/coverage.hpp"
#include "output/frame_report.hpp"
#include "output/json_text.hpp"
#include "output/map_summary.hpp"
#include "output/refusal.hpp"
#include "reports/consistency_report.hpp"

#include <cstdio>
#include <filesystem>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/mesh_extraction.hpp>

namespace tofmap::app {
namespace {

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

/// Throws InputError if no frame was found in the map that is extended. While a run is interrupted,
/// that may still come.
void refuse_another_place(const RoomMap& map, bool has_start) {
  if (!map.localised || *map.localised > 0 || map.interrupted) return;
  throw InputError(told_refusal(map.nearness, map.frames, has_start));
}

/// Whether an extended map is worse than the map before, and no loop has shown that this was wrong.
/// Loops of a recording with warnings show nothing: its ranges may be wrong.
bool is_to_be_taken_back(const FinishedMap& finished, const MapEvidence& evidence,
                         const MapFile& file, const MapOutputChoices& choices) {
  const auto before = file.verdict_before();
  const bool is_explained = finished.map.has_moved_map && evidence.warnings == 0;
  return before && verdict_on_extension(evidence) > *before && !finished.map.interrupted &&
         !is_explained && !choices.even_if_worse;
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
  if (const auto& onto = output.choices.onto; !onto.empty()) {
    report["extends"] = {{"map", onto.string()}, {"taken_back", finished.is_taken_back}};
  }
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

/// Brings the sampled frames back, and adds consistency measures, mesh and map.pcd. A failure of
/// one of them is stored, and the others are still added.
void add_what_follows(const OutputFolder& out, FinishedMap& finished, MapOutput& output) {
  const auto add_file = [&](const char* name, const auto& write) {
    const std::filesystem::path file = out.path() / name;
    std::error_code ignored;
    if (!output.failures.attempt(name, [&] { write(file); })) {
      std::filesystem::remove(file, ignored);
    }
  };
  output.failures.attempt("some frames of the page", [&] { output.sample.bring_back(); });
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
  if (output.choices.pcd) {
    add_file("map.pcd", [&](const auto& file) { write_map(file, surface); });
  }
}

}  // namespace

FinishedMap finish_map(MapRun& run, MapFile& file, OutputFolder& out, MapOutput& output) {
  FinishedMap finished{.map = run.finish(), .consistency = unknown_consistency()};
  check_result(finished.map);
  refuse_another_place(finished.map, output.choices.has_start);
  write_map_and_path(out, finished.map);
  add_what_follows(out, finished, output);
  output.warnings = all_warnings(output.survey, finished.map, finished.consistency);
  if (!output.losses.empty()) output.warnings.push_back("not mapped: " + output.losses);
  const MapEvidence evidence =
      evidence_of(finished.map, output.options.pipeline, finished.consistency, output.warnings);
  finished.judgement = judge(evidence);
  finished.is_taken_back = is_to_be_taken_back(finished, evidence, file, output.choices);
  if (finished.is_taken_back) {
    file.discard();
    output.warnings.push_back(output.choices.onto.string() +
                              " was not extended, since the map would be worse with the recording; "
                              "this report shows how");
  }
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
      output.choices.resume ? Completeness::resumable : Completeness::interrupted;
  out.commit(finished.map.interrupted ? interrupted
             : finished.is_taken_back ? Completeness::taken_back
                                      : Completeness::whole);
  for (const std::string& text : output.failures.texts()) {
    std::fprintf(stderr, "tofmap: %s holds the map, but without %s\n", out.final_path().c_str(),
                 text.c_str());
  }
  if (!output.choices.quiet) {
    print_summary(finished.map, out.final_path());
    print_changes(finished.map.changes, output.recordings);
    print_warnings(output.warnings);
    const Judgement& judgement = finished.judgement;
    std::printf("verdict: %s%s\n", std::string(sentence_of(judgement.verdict)).c_str(),
                told_reasons(judgement).c_str());
  }
  return finished;
}

}  // namespace tofmap::app
