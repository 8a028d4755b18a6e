// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"

#include <CLI/CLI.hpp>
#include <omp.h>

namespace tofmap::app {

std::vector<OptionField<RunOptions>> RunOptions::fields() {
  return {{"threads", &RunOptions::threads, 0, 1024, "",
           "threads to use; 0: all. The result is the same for any number"}};
}

void CommonArguments::add_to(CLI::App& command) {
  command.add_option("--config", config, "YAML file with options, see 'tofmap config'");
  command.add_option("--set", assignments, "one option: group.name=value (repeatable)")
      ->expected(1)
      ->take_all();
  command.add_option("--threads", threads, "threads to use, 0: all")->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", quiet, "no progress and no summary");
}

void CommonArguments::resolve(OptionTable& table, RunOptions& run) const {
  if (!config.empty()) table.load(config, AllOptions().table());
  for (const std::string& assignment : assignments) table.assign(assignment);
  if (threads >= 0) run.threads = threads;
  if (run.threads > 0) omp_set_num_threads(run.threads);
}

}  // namespace tofmap::app
