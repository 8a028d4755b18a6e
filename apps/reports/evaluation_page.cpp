// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/evaluation_page.hpp"

#include "reports/error_curves.hpp"
#include "reports/evaluation_report.hpp"
#include "reports/map_section.hpp"
#include "reports/report_sections.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

const MethodResult* find(const std::vector<MethodResult>& results, UnwrapMethod method) {
  const auto found = std::ranges::find(results, method, &MethodResult::method);
  return found == results.end() ? nullptr : &*found;
}

/// The method shown as "with unwrapping": the one that the command `map` would use or, if that was
/// not run, the last one that unwraps.
const MethodResult& with_unwrapping(const EvaluationPageSubject& subject) {
  const MethodResult* found = find(subject.results, subject.options.pipeline.unwrap.method);
  if (found) return *found;
  const auto last = std::ranges::find_if(
      subject.results.rbegin(), subject.results.rend(),
      [](const MethodResult& result) { return result.method != UnwrapMethod::none; });
  return last != subject.results.rend() ? *last : subject.results.back();
}

const MethodResult* without_unwrapping(const EvaluationPageSubject& subject) {
  const MethodResult* found = find(subject.results, UnwrapMethod::none);
  return found == &with_unwrapping(subject) ? nullptr : found;
}

/// The scores of the frames whose true ranges are known.
std::vector<RangeScore> scores_of(const MethodResult& result) {
  std::vector<RangeScore> scores;
  for (const UnwrappingRecord& frame : result.frames) {
    if (frame.score) scores.push_back(*frame.score);
  }
  return scores;
}

/// A clause about the result of a method, from the last stage that the truth is known for: "the map
/// is 9 mm off the true surface and shows 98.6 % of what was seen".
std::string told(const MethodResult& result) {
  std::string text;
  if (result.scores.surface) {
    text = fmt::format(
        "the map is {:.0f} mm off the true surface and shows {:.1f} % of what was seen",
        1000 * result.scores.surface->accuracy_m, result.scores.surface->completeness_percent);
  } else if (result.scores.trajectory) {
    text = fmt::format("the path is {:.0f} mm off", 1000 * result.scores.trajectory->ate_rmse_m);
  } else if (result.map) {
    text = std::to_string(result.map->trajectory.size()) + " of " +
           counted(result.map->frames.size(), "frame") + " are in one map";
  } else {
    const std::vector<RangeScore> scores = scores_of(result);
    if (scores.empty()) return counted(result.frames.size(), "frame") + " were unwrapped";
    text = fmt::format("{:.2f} % of the ranges are off by more than half a wavelength",
                       mean_score(scores).wrong_wrap_percent);
  }
  return text;
}

std::string sentence_of(const EvaluationPageSubject& subject) {
  const MethodResult& with = with_unwrapping(subject);
  std::string text = (with.method == UnwrapMethod::none ? "Without unwrapping "
                                                        : "With unwrapping (" + with.name + ") ") +
                     told(with);
  if (const MethodResult* without = without_unwrapping(subject)) {
    text += "; without it, " + told(*without);
  }
  text += ".";
  if (with.map && subject.truth.poses.empty()) text += " The true path is not known.";
  return text;
}

std::vector<std::string> warnings_of(const EvaluationPageSubject& subject) {
  std::vector<std::string> warnings = all_warnings(subject.survey, with_unwrapping(subject));
  std::ranges::copy(subject.warnings, std::back_inserter(warnings));
  return warnings;
}

Judgement judgement_of(const EvaluationPageSubject& subject) {
  const MethodResult& with = with_unwrapping(subject);
  if (with.map) {
    MapEvidence evidence = evidence_of(with, subject.options.pipeline, warnings_of(subject));
    if (with.scores.surface) evidence.accuracy_m = with.scores.surface->accuracy_m;
    return judge(evidence);
  }
  const Verdict of_ranges = verdict_on_wraps(mean_score(scores_of(with)).wrong_wrap_percent);
  return {.verdict = std::max(of_ranges, subject.warnings.empty() ? Verdict::good : Verdict::check),
          .reasons = {},
          .remarks = {}};
}

std::vector<ShownMap> shown_maps(const EvaluationPageSubject& subject) {
  std::vector<ShownMap> maps;
  for (const MethodResult* result : {&with_unwrapping(subject), without_unwrapping(subject)}) {
    if (!result) continue;
    maps.push_back(shown_map(name_of_map(result->method), *result->map, result->scores));
  }
  return maps;
}

void add_curves(ReportPage& page, const EvaluationPageSubject& subject) {
  std::vector<MethodErrors> methods;
  for (const MethodResult& result : subject.results) {
    methods.push_back({result.name, {}, result.frames});
    if (!result.scores.trajectory) continue;
    methods.back().path = pose_errors(result.map->trajectory, subject.truth.poses,
                                      result.scores.trajectory->truth_from_estimate);
  }
  add_error_curves(page, methods);
}

/// The table of methods, with its two header lines joined into one.
PageTable methods_table(const nlohmann::ordered_json& report) {
  std::vector<std::vector<std::string>> lines = table_of(report);
  PageTable table{lines[0], {lines.begin() + 2, lines.end()}};
  for (std::size_t i = 1; i < table.header.size(); ++i) table.header[i] += " " + lines[1][i];
  return table;
}

void add_runs(ReportPage& page, const EvaluationPageSubject& subject) {
  std::vector<std::string> names;
  std::vector<Consistency> consistencies;
  std::vector<const RoomMap*> runs;
  for (const MethodResult& result : subject.results) {
    if (!result.map) continue;
    names.push_back(result.name);
    consistencies.push_back(*result.consistency);
    runs.push_back(&*result.map);
  }
  if (runs.empty()) return;
  add_consistency(page, names, consistencies);
  add_stage_times(page, names, runs);
}

}  // namespace

void write_evaluation_page(const std::filesystem::path& result,
                           const EvaluationPageSubject& subject) {
  const MethodResult& with = with_unwrapping(subject);
  ReportPage page("With and without unwrapping: " + subject.recording.folder().string(),
                  "tofmap " TOFMAP_VERSION);
  const Judgement judgement = judgement_of(subject);
  page.add_verdict(judgement.verdict, sentence_of(subject) + told_reasons(judgement));
  std::vector<std::string> warnings = warnings_of(subject);
  std::ranges::move(subject.recorded_truth.remarks(), std::back_inserter(warnings));
  page.add_warnings(warnings);
  page.add_heading("Methods");
  page.add_table(methods_table(subject.report));
  if (with.map) add_maps(page, shown_maps(subject), subject.truth.poses, subject.options.report);
  add_curves(page, subject);
  add_frames(
      page, with.sample, subject.recording.sensor().modulation,
      [&](int index) { return subject.recorded_truth.range_m(index); }, subject.options.report);
  add_runs(page, subject);
  add_options(page, subject.options_yaml);
  write_page(result, page);
}

}  // namespace tofmap::app
