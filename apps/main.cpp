// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/failure.hpp"
#include "console/interruption.hpp"

#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace {

namespace exit_status = tofmap::app::exit_status;

int fail(int status, const std::string& message) {
  std::fprintf(stderr, "tofmap: %s\n", message.c_str());
  return status;
}

/// Throws InputError if standard output could not be written, since it may be the result, as for
/// `config`.
void flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw tofmap::InputError("standard output cannot be written; is the disk full?");
  }
}

int run(int argc, char** argv) {
  using namespace tofmap::app;
  CLI::App program("Maps of large rooms from multi-frequency time-of-flight cameras", "tofmap");
  program.set_version_flag("--version", TOFMAP_VERSION);
  program.require_subcommand(1);
  Outcome outcome;
  add_simulate_command(program, outcome);
  add_record_command(program, outcome);
  add_import_command(program, outcome);
  add_info_command(program, outcome);
  add_calibrate_command(program, outcome);
  add_unwrap_command(program, outcome);
  add_map_command(program, outcome);
  add_localise_command(program, outcome);
  add_merge_command(program, outcome);
  add_register_command(program, outcome);
  add_evaluate_command(program, outcome);
  add_view_command(program, outcome);
  add_config_command(program, outcome);
  add_manual_command(program, outcome);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string first = argc > 1 ? argv[1] : "";
    const auto is_first = [&](const CLI::App* one) { return one->check_name(first); };
    const bool is_word = !first.empty() && !first.starts_with('-');
    if (is_word && program.get_subcommands(is_first).empty()) {
      return fail(exit_status::bad_use,
                  "there is no command '" + first + "'; 'tofmap --help' lists all commands");
    }
    if (error.get_exit_code() == 0) return program.exit(error);  // the user asked for help
    return fail(exit_status::bad_use, fmt::format("{}; 'tofmap {}--help' lists what can be given",
                                                  error.what(), is_word ? first + " " : ""));
  }
  return outcome.status;
}

}  // namespace

int main(int argc, char** argv) {
  tofmap::app::watch_for_interruption();
  try {
    const int status = run(argc, argv);
    flush_output();
    return status;
  } catch (const tofmap::app::Interrupted&) {
    return fail(exit_status::interrupted, "interrupted before there was a result");
  } catch (const std::exception&) {
    const tofmap::app::Failure failure = tofmap::app::failure_of(std::current_exception());
    return fail(failure.status, failure.message);
  }
}
