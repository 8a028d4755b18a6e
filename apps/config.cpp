// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

struct AllOptions::Values {
  RunOptions run;
  SimulatorOptions simulator;
  PipelineOptions pipeline;
};

AllOptions::AllOptions() : values_(std::make_unique<Values>()) {
  table_.bind("", values_->run);
  table_.bind("simulator", values_->simulator);
  bind_options(table_, values_->pipeline);
}

AllOptions::~AllOptions() = default;

std::string command_options_yaml(const std::string& command) {
  if (command.empty()) return AllOptions().table().to_yaml(true);
  RunOptions run;
  SimulatorOptions simulator;
  PipelineOptions pipeline;
  OptionTable table;
  table.bind("", run);
  if (command == "simulate") table.bind("simulator", simulator);
  if (command == "unwrap") {
    table.bind("unwrap", pipeline.unwrap);
    table.bind("filters", pipeline.filters);
  } else if (command == "map" || command == "evaluate") {
    bind_options(table, pipeline);
  } else if (command != "simulate" && command != "info") {
    throw UsageError("config: '" + command +
                     "' is no command with options; there are: simulate, info, unwrap, map, "
                     "evaluate");
  }
  return table.to_yaml(true);
}

void add_config_command(CLI::App& program, Outcome& /*outcome*/) {
  auto command = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand(
      "config", "print every option with default, unit, range and meaning, as YAML");
  app->add_option("COMMAND", *command, "only the options of this command");
  app->callback([command] { std::fputs(command_options_yaml(*command).c_str(), stdout); });
}

}  // namespace tofmap::app
