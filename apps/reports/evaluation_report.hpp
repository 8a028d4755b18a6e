// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/watched_source.hpp"

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/evaluation/method_run.hpp>

namespace tofmap::app {

/// Adds the figures of a method to report.json, as `<group>.<method>.<metric>_<unit>`
/// (docs/commands.md).
void add_to_report(nlohmann::ordered_json& report, const MethodResult& result);

/// The warnings about a recording and the map that a method has made of it.
std::vector<std::string> all_warnings(const SourceSurvey& recording, const MethodResult& result);

/// The evidence about the map of a method, without ground truth. `warnings` are all_warnings(). The
/// result must have a map.
MapEvidence evidence_of(const MethodResult& result, const PipelineOptions& options,
                        const std::vector<std::string>& warnings);

/// Adds the verdict on the map of a method to report.json, as `map` without ground truth gives it.
/// Does nothing if there is no map.
void add_judgement(nlohmann::ordered_json& report, const MethodResult& result,
                   const PipelineOptions& options, const std::vector<std::string>& warnings);

/// A table of the most important figures: two header lines (name and unit), then one line per
/// method. Unknown figures are "-".
std::vector<std::vector<std::string>> table_of(const nlohmann::ordered_json& report);

/// Prints table_of(report) on stdout.
void print_table(const nlohmann::ordered_json& report);

}  // namespace tofmap::app
