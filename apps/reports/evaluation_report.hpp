// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/evaluation/method_run.hpp>

namespace tofmap::app {

/// Adds the figures of a method to report.json, as `<group>.<method>.<metric>_<unit>`
/// (docs/commands.md).
void add_to_report(nlohmann::ordered_json& report, const MethodResult& result);

/// A table of the most important figures: two header lines (name and unit), then one line per
/// method. Unknown figures are "-".
std::vector<std::vector<std::string>> table_of(const nlohmann::ordered_json& report);

/// Prints table_of(report) on stdout.
void print_table(const nlohmann::ordered_json& report);

}  // namespace tofmap::app
