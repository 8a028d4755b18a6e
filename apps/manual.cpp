// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual/manual.hpp"

#include "command.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

namespace tofmap::app {

void add_manual_command(CLI::App& program, Outcome& /*outcome*/) {
  auto what = std::make_shared<std::string>("page");
  CLI::App* app = program.add_subcommand(
      "manual", "print the manual page, the completion for bash, or the table of all options");
  app->add_option(
         "WHAT", *what,
         "page: manual page for 'man -l -'; bash: completion for 'source'; options: Markdown table")
      ->check(CLI::IsMember({"page", "bash", "options"}));
  app->callback([what, &program] {
    const std::string text = *what == "page"   ? manual_page(program)
                             : *what == "bash" ? bash_completion(program)
                                               : option_reference();
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace tofmap::app
