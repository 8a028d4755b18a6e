// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual/description.hpp"
#include "manual/manual.hpp"
#include "options/options.hpp"

#include <algorithm>
#include <sstream>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

/// The names of the commands that have a group of options.
std::vector<std::string> commands_with(const std::string& group) {
  std::vector<std::string> names;
  for (const std::string& name : commands_with_options()) {
    ProgramOptions options;
    const std::vector<OptionText> texts = option_table(name, options).texts();
    if (std::ranges::find(texts, group, &OptionText::group) != texts.end()) names.push_back(name);
  }
  return names;
}

/// A text with | escaped, which would end a table cell in Markdown.
std::string cell(std::string text) {
  for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2)) {
    text.insert(i, "\\");
  }
  return text;
}

}  // namespace

std::string option_reference() {
  std::ostringstream out;
  out << "# Options\n\nEvery option of `--set group.name=value` and of a file for `--config`, as "
         "`tofmap manual options` prints\nthem. `tofmap config COMMAND` prints the options of a "
         "command as YAML, for use with `--config`.\n";
  ProgramOptions options;
  bool is_first = true;
  std::string group;
  for (const OptionText& option : option_table("", options).texts()) {
    if (is_first || option.group != group) {
      group = option.group;
      out << "\n## " << (group.empty() ? "Without a group" : group) << "\n\nOf "
          << joined(commands_with(group), ", ")
          << ".\n\n| option | default | allowed | meaning |\n|---|---|---|---|\n";
      is_first = false;
    }
    out << "| `" << option.key() << "` | " << cell(option.value) << " | " << cell(limits(option))
        << " | " << cell(option.meaning) << " |\n";
  }
  return out.str();
}

}  // namespace tofmap::app
