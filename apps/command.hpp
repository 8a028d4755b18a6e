// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace CLI {
class App;
}

namespace tofmap::app {

/// Exit status of the program (docs/commands.md).
namespace exit_status {
inline constexpr int done = 0;
inline constexpr int own_fault = 1;
inline constexpr int bad_use = 2;
inline constexpr int bad_input = 3;
inline constexpr int interrupted = 130;
}  // namespace exit_status

struct ProgramOptions;

/// What every command takes from the command line: --config, --set, --threads, --quiet.
struct CommonArguments {
  std::filesystem::path config;
  std::vector<std::string> assignments;
  int threads = -1;  ///< −1: as the configuration says
  bool quiet = false;

  void add_to(CLI::App& command);

  /// The options of a command: defaults, then the file's, then those of --set; applies the
  /// threads. Groups of the file that are other commands' alone are passed over. The table is
  /// bound to `options`.
  OptionTable resolve(const std::string& command, ProgramOptions& options) const;
};

/// Adds --method; `method` stays empty where it is not given.
void add_method_option(CLI::App& command, std::string& method,
                       const std::string& meaning = "how to unwrap (default: unwrap.method)");

/// Where commands leave their exit status.
struct Outcome {
  int status = exit_status::done;
};

void add_calibrate_command(CLI::App& program, Outcome& outcome);
void add_simulate_command(CLI::App& program, Outcome& outcome);
void add_record_command(CLI::App& program, Outcome& outcome);
void add_info_command(CLI::App& program, Outcome& outcome);
void add_unwrap_command(CLI::App& program, Outcome& outcome);
void add_map_command(CLI::App& program, Outcome& outcome);
void add_register_command(CLI::App& program, Outcome& outcome);
void add_evaluate_command(CLI::App& program, Outcome& outcome);
void add_view_command(CLI::App& program, Outcome& outcome);
void add_config_command(CLI::App& program, Outcome& outcome);
void add_manual_command(CLI::App& program, Outcome& outcome);

}  // namespace tofmap::app
