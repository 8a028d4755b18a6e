// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/evaluation/method_run.hpp>

namespace tofmap::app {

/// Adds a method's figures as `<group>.<method>.<metric>_<unit>` (docs/commands.md).
void add_to_report(nlohmann::ordered_json& report, const MethodResult& result);

/// The figures that matter most: two lines of headings (what, and its unit), then a line a method.
/// What is not known is "-".
std::vector<std::vector<std::string>> table_of(const nlohmann::ordered_json& report);

/// The same on stdout.
void print_table(const nlohmann::ordered_json& report);

}  // namespace tofmap::app
