// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/options.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {

std::vector<OptionField<RunOptions>> RunOptions::fields() {
  return {{"threads", &RunOptions::threads, 0, 1024, "",
           "number of threads; 0: all. It does not change the result"}};
}

const std::vector<std::string>& commands_with_options() {
  static const std::vector<std::string> commands = {"simulate",  "record",   "import",   "info",
                                                    "calibrate", "unwrap",   "map",      "localise",
                                                    "merge",     "register", "evaluate", "view"};
  return commands;
}

OptionTable option_table(const std::string& command, ProgramOptions& options) {
  const auto is_any_of = [&](std::initializer_list<std::string_view> names) {
    return command.empty() || std::ranges::find(names, command) != names.end();
  };
  const std::vector<std::string>& known = commands_with_options();
  if (!command.empty() && std::ranges::find(known, command) == known.end()) {
    throw UsageError("'" + command +
                     "' is not a command with options; allowed: " + joined(known, ", "));
  }
  if (command == "unwrap") options.pipeline.filters.chain = smoothing_chain();
  OptionTable table;
  table.bind("", options.run);
  if (is_any_of({"simulate"})) {
    table.bind("simulator", options.simulator);
    table.bind("tum", options.tum);
  }
  if (is_any_of({"record", "info", "unwrap", "map", "localise", "evaluate", "view"})) {
    table.bind("camera", options.camera);
  }
  if (is_any_of({"record", "map", "localise"})) {
    table.bind("device", options.device);
    table.bind("live", options.live);
  }
  if (is_any_of({"calibrate"})) table.bind("calibration", options.calibration);
  if (is_any_of({"map", "localise", "evaluate"})) {
    bind_options(table, options.pipeline);
  } else if (is_any_of({"merge"})) {
    table.bind("registration", options.pipeline.registration);
    table.bind("odometry", options.pipeline.odometry);
    table.bind("loops", options.pipeline.loops);
  } else if (is_any_of({"calibrate"})) {
    table.bind("unwrap", options.pipeline.unwrap);
  } else if (is_any_of({"unwrap", "view"})) {
    table.bind("unwrap", options.pipeline.unwrap);
    table.bind("filters", options.pipeline.filters);
  }
  if (is_any_of({"unwrap"})) table.bind("fusion", options.fusion);
  if (is_any_of({"register"})) table.bind("register", options.cloud_registration);
  if (is_any_of({"evaluate"})) table.bind("evaluation", options.evaluation);
  if (is_any_of({"unwrap", "map", "evaluate"})) table.bind("pictures", options.pictures);
  if (is_any_of({"map", "evaluate"})) table.bind("report", options.report);
  return table;
}

}  // namespace tofmap::app
