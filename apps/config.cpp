// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "options/options.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

namespace tofmap::app {

void add_config_command(CLI::App& program, Outcome& /*outcome*/) {
  auto command = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand(
      "config", "print every option with default, unit, range and meaning, as YAML");
  app->add_option("COMMAND", *command, "only the options of this command");
  app->callback([command] {
    ProgramOptions options;
    std::fputs(option_table(*command, options).to_yaml(true).c_str(), stdout);
  });
}

}  // namespace tofmap::app
