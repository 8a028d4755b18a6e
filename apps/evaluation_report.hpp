// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "method_run.hpp"

#include <nlohmann/json_fwd.hpp>

namespace tofmap::app {

/// Adds a method's figures as `<group>.<method>.<metric>_<unit>` (docs/commands.md).
void add_to_report(nlohmann::ordered_json& report, const MethodResult& result);

/// The figures that matter most, a line a method, on stdout.
void print_table(const nlohmann::ordered_json& report);

}  // namespace tofmap::app
