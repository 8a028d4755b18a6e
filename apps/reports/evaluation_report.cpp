// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/evaluation_report.hpp"

#include "output/frame_report.hpp"
#include "reports/consistency_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

Json unwrapping_json(const MethodResult& result) {
  Json json;
  std::vector<RangeScore> scores;
  double milliseconds = 0;
  double iterations = 0;
  double converged = 0;
  bool can_converge = false;
  for (const UnwrappingRecord& frame : result.frames) {
    if (frame.score) scores.push_back(*frame.score);
    milliseconds += frame.milliseconds;
    iterations += frame.iterations;
    converged += frame.converged.value_or(false) ? 1 : 0;
    can_converge = can_converge || frame.converged.has_value();
  }
  if (!scores.empty()) {
    const RangeScore mean = mean_score(scores);
    json["wrong_wrap_percent"] = json_number(mean.wrong_wrap_percent);
    json["coverage_percent"] = json_number(mean.coverage_percent);
    json["range_rmse_m"] = json_number(mean.range_rmse_m);
  }
  const auto count = static_cast<double>(result.frames.size());
  if (can_converge) json["converged_percent"] = json_number(100 * converged / count);
  json["iterations_per_frame"] = json_number(iterations / count);
  json["milliseconds_per_frame"] = json_number(milliseconds / count);
  return json;
}

Json over_range_json(const MethodResult& result) {
  Json bins = Json::array();
  for (const ErrorsOverRange::Bin& bin : over_range(result.frames).bins()) {
    bins.push_back({{"range_m", bin.range_m},
                    {"pixels", bin.pixels},
                    {"wrong_wrap_percent", json_number(bin.wrong_wrap_percent)},
                    {"range_rmse_m", json_number(bin.range_rmse_m)}});
  }
  return bins;
}

Json trajectory_json(const MethodResult& result) {
  Json json = {{"registered_frames", result.map->trajectory.size()},
               {"separate_maps", result.map->separate_maps.size()}};
  if (!result.scores.trajectory) return json;
  json["ate_rmse_m"] = json_number(result.scores.trajectory->ate_rmse_m);
  json["ate_max_m"] = json_number(result.scores.trajectory->ate_max_m);
  json["rpe_rmse_m_per_m"] = json_number(result.scores.trajectory->rpe_rmse_m_per_m);
  json["rpe_rmse_deg_per_m"] = json_number(result.scores.trajectory->rpe_rmse_deg_per_m);
  return json;
}

/// Percentages of the valid pixels after unwrapping that filters removed, per filter and in total.
Json filters_json(const MethodResult& result) {
  double valid = 0;
  double kept = 0;
  std::map<std::string, double> removed;
  for (const FrameRecord& frame : result.map->frames) {
    valid += frame.valid_pixels;
    kept += frame.kept_pixels;
    for (const FilterCount& count : frame.filters)
      removed[std::string(name_of(count.filter))] += count.removed;
  }
  Json json = {{"removed_percent", json_number(100 * (valid - kept) / valid)}};
  for (const auto& [name, pixels] : removed)
    json[name + "_percent"] = json_number(100 * pixels / valid);
  return json;
}

Json map_json(const MethodResult& result) {
  Json json = {{"points", result.map->surface.size()}};
  if (result.scores.surface) {
    json["accuracy_m"] = json_number(result.scores.surface->accuracy_m);
    json["far_percent"] = json_number(result.scores.surface->far_percent);
    json["completeness_percent"] = json_number(result.scores.surface->completeness_percent);
  }
  json["milliseconds_per_frame"] = summary_json(*result.map)["milliseconds_per_frame"];
  return json;
}

struct Column {
  const char* group;
  const char* metric;
  const char* title;
  const char* unit;
  int decimals;
  bool is_hidden_if_zero = false;  ///< the column is left out if it is 0 for all methods
};

constexpr std::array columns{
    Column{"unwrapping", "wrong_wrap_percent", "wrong", "wraps %", 3},
    Column{"unwrapping", "range_rmse_m", "range", "RMSE m", 3},
    Column{"unwrapping", "milliseconds_per_frame", "unwrap", "ms/frame", 1},
    Column{"filters", "removed_percent", "filters", "remove %", 1},
    Column{"trajectory", "registered_frames", "frames", "registered", 0},
    Column{"trajectory", "separate_maps", "other", "maps", 0, true},
    Column{"trajectory", "ate_rmse_m", "ATE", "RMSE m", 4},
    Column{"trajectory", "rpe_rmse_m_per_m", "RPE", "m per m", 4},
    Column{"map", "accuracy_m", "map", "error m", 4},
    Column{"map", "completeness_percent", "map", "seen %", 1},
    Column{"judgement", "verdict", "verdict", "w/o truth", 0},
    Column{"map", "milliseconds_per_frame", "all", "ms/frame", 1}};

std::string cell(const Json& report, const Column& column, const std::string& method) {
  const auto group = report.find(column.group);
  if (group == report.end() || !group->contains(method)) return "-";
  const Json& values = (*group)[method];
  if (!values.contains(column.metric)) return "-";
  const Json& value = values[column.metric];
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number()) return "-";
  return fmt::format("{:.{}f}", value.get<double>(), column.decimals);
}

/// Whether a column is not worth its place in the table.
bool is_hidden(const Json& report, const Column& column) {
  const auto group = report.find(column.group);
  if (group == report.end()) return true;
  if (!column.is_hidden_if_zero) return false;
  return std::ranges::all_of(*group, [&](const Json& values) {
    return !values.contains(column.metric) || values[column.metric] == 0;
  });
}

}  // namespace

void add_to_report(Json& report, const MethodResult& result) {
  report["unwrapping"][result.name] = unwrapping_json(result);
  Json bins = over_range_json(result);
  if (!bins.empty()) report["over_range"][result.name] = std::move(bins);
  if (!result.map) return;
  report["consistency"][result.name] = consistency_json(*result.consistency);
  report["filters"][result.name] = filters_json(result);
  report["trajectory"][result.name] = trajectory_json(result);
  report["map"][result.name] = map_json(result);
}

std::vector<std::string> all_warnings(const SourceSurvey& recording, const MethodResult& result) {
  if (!result.map) return warnings_about(recording);
  return all_warnings(recording, *result.map, *result.consistency);
}

MapEvidence evidence_of(const MethodResult& result, const PipelineOptions& options,
                        const std::vector<std::string>& warnings) {
  PipelineOptions of_method = options;
  of_method.unwrap.method = result.method;
  return evidence_of(*result.map, of_method, *result.consistency, warnings);
}

void add_judgement(Json& report, const MethodResult& result, const PipelineOptions& options,
                   const std::vector<std::string>& warnings) {
  if (!result.map) return;
  report["judgement"][result.name] = judgement_json(judge(evidence_of(result, options, warnings)));
}

std::vector<std::vector<std::string>> table_of(const Json& report) {
  std::vector<std::vector<std::string>> lines{{"method"}, {""}};
  for (const auto& [method, values] : report["unwrapping"].items()) lines.push_back({method});
  for (const Column& column : columns) {
    if (is_hidden(report, column)) continue;
    lines[0].push_back(column.title);
    lines[1].push_back(column.unit);
    for (std::size_t i = 2; i < lines.size(); ++i) {
      lines[i].push_back(cell(report, column, lines[i].front()));
    }
  }
  return lines;
}

void print_table(const Json& report) {
  for (const std::vector<std::string>& line : table_of(report)) {
    std::printf("%-8s", line.front().c_str());
    for (std::size_t i = 1; i < line.size(); ++i) std::printf(" %10s", line[i].c_str());
    std::printf("\n");
  }
}

}  // namespace tofmap::app
