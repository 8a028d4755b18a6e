// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"

#include "options/options.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <omp.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

/// Throws UsageError if the option of an assignment is one of other commands only.
void refuse_foreign_option(const std::string& assignment, const std::string& command,
                           const OptionTable& table) {
  const std::string group = assignment.substr(0, assignment.find_first_of(".="));
  if (table.has_group(group)) return;
  std::vector<std::string> owners;
  for (const std::string& other : commands_with_options()) {
    ProgramOptions unused;
    if (option_table(other, unused).has_group(group)) owners.push_back(other);
  }
  if (owners.empty()) return;
  throw UsageError("--set " + assignment + ": 'tofmap " + command + "' has no group " + group +
                   "; it belongs to " + joined(owners, ", "));
}

}  // namespace

void CommonArguments::add_to(CLI::App& command) {
  command.add_option("--config", config, "YAML file with options, see 'tofmap config'");
  command.add_option("--set", assignments, "set an option, as group.name=value; may be repeated")
      ->expected(1)
      ->take_all();
  command.add_option("--threads", threads, "number of threads; 0: all")->check(CLI::Range(0, 1024));
  command.add_flag("--quiet", quiet, "print neither progress nor summary");
}

OptionTable CommonArguments::resolve(const std::string& command, ProgramOptions& options) const {
  OptionTable table = option_table(command, options);
  ProgramOptions defaults;
  if (!config.empty()) table.load(config, option_table("", defaults));
  for (const std::string& assignment : assignments) {
    refuse_foreign_option(assignment, command, table);
    table.assign(assignment);
  }
  if (threads >= 0) options.run.threads = threads;
  if (options.run.threads > 0) omp_set_num_threads(options.run.threads);
  return table;
}

void add_method_option(CLI::App& command, std::string& method, const std::string& meaning) {
  command.add_option("--method", method, meaning)
      ->type_name("{" + all_names<UnwrapMethod>(",") + "}");
}

}  // namespace tofmap::app
