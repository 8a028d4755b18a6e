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

/// The exit statuses of the program (docs/commands.md).
namespace exit_status {
inline constexpr int done = 0;
inline constexpr int own_fault = 1;      ///< an error in the program, out of memory, or no display
inline constexpr int bad_use = 2;        ///< UsageError: wrong arguments or options
inline constexpr int bad_input = 3;      ///< InputError: files or devices cannot be read or written
inline constexpr int interrupted = 130;  ///< ended by Ctrl-C or SIGTERM
}  // namespace exit_status

struct ProgramOptions;

/// The command line arguments that every command has: --config, --set, --threads and --quiet.
struct CommonArguments {
  std::filesystem::path config;          ///< YAML file with options; empty if none is given
  std::vector<std::string> assignments;  ///< "group.name=value", in the order given
  int threads = -1;                      ///< number of threads; 0: all; −1: not given
  bool quiet = false;                    ///< prints neither progress nor summary

  /// Adds the arguments to the command line of `command`.

  void add_to(CLI::App& command);

  /// Sets `options` for a command from the defaults, the --config file and --set, of which later
  /// ones override earlier ones, and sets the number of OpenMP threads. Groups of the file that
  /// only other commands have are ignored. Returns the table of the command's options, which is
  /// bound to `options`. Throws UsageError for unknown options and values that are not allowed.
  OptionTable resolve(const std::string& command, ProgramOptions& options) const;
};

/// Adds --method to a command. `method` stays empty if the argument is not given.
void add_method_option(CLI::App& command, std::string& method,
                       const std::string& meaning = "how to unwrap (default: unwrap.method)");

/// The exit status of the command that was run.
struct Outcome {
  int status = exit_status::done;
};

void add_calibrate_command(CLI::App& program, Outcome& outcome);
void add_simulate_command(CLI::App& program, Outcome& outcome);
void add_record_command(CLI::App& program, Outcome& outcome);
void add_import_command(CLI::App& program, Outcome& outcome);
void add_info_command(CLI::App& program, Outcome& outcome);
void add_unwrap_command(CLI::App& program, Outcome& outcome);
void add_map_command(CLI::App& program, Outcome& outcome);
void add_localise_command(CLI::App& program, Outcome& outcome);
void add_merge_command(CLI::App& program, Outcome& outcome);
void add_register_command(CLI::App& program, Outcome& outcome);
void add_evaluate_command(CLI::App& program, Outcome& outcome);
void add_view_command(CLI::App& program, Outcome& outcome);
void add_config_command(CLI::App& program, Outcome& outcome);
void add_manual_command(CLI::App& program, Outcome& outcome);

}  // namespace tofmap::app
