// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual/description.hpp"
#include "manual/manual.hpp"

#include <ostream>
#include <sstream>

#include <CLI/CLI.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

/// Writes a bash case with the options of a command and the keys of its settings.
void write_words(std::ostream& out, const CLI::App& command) {
  std::vector<std::string> options;
  for (const CLI::Option* option : named_options(command)) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  std::vector<std::string> keys;
  for (const OptionText& setting : settings_of(command)) keys.push_back(setting.key() + "=");
  out << "    " << command.get_name() << ")\n      options=\"" << joined(options, " ")
      << "\"\n      keys=\"" << joined(keys, " ") << "\" ;;\n";
}

/// Writes bash cases with the allowed values of a command's options, arguments and settings. A case
/// is selected by command, preceding word and setting.
void write_choices(std::ostream& out, const CLI::App& command) {
  const std::string& name = command.get_name();
  const auto write = [&](const std::string& before, const std::string& key,
                         const std::vector<std::string>& choices) {
    if (choices.empty()) return;
    out << "    " << name << ':' << before << ':' << key << ") choices=\"" << joined(choices, " ")
        << "\" ;;\n";
  };
  for (const CLI::Option* option : named_options(command)) {
    for (const std::string& word : option->get_lnames())
      write("--" + word, "", choices_of(*option));
  }
  for (const CLI::Option* positional : positionals(command)) {
    write(name, "", choices_of(*positional));
  }
  for (const OptionText& setting : settings_of(command)) {
    write("*", setting.key(), choices_of(setting));
  }
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  std::ostringstream out;
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
  out << "# bash completion of tofmap " << TOFMAP_VERSION << "\n"
      << R"(_tofmap() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} option= options= keys= i
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W ")"
      << joined(names, " ") << R"(" -- "$word"))
    return
  fi
  case $command in
)";
  for (const CLI::App* command : commands_of(program)) write_words(out, *command);
  // Bash splits a setting and its value into three words: key, = and value.
  out << R"(  esac
  for ((i = COMP_CWORD - 1; i > 1; i--)); do
    [[ ${COMP_WORDS[i]} == -* ]] && option=${COMP_WORDS[i]} && break
  done
  local before=${COMP_WORDS[COMP_CWORD - 1]} key= choices=
  [[ $word == = ]] && key=$before && word=
  [[ $before == = ]] && key=${COMP_WORDS[COMP_CWORD - 2]}
  [[ $key == --* ]] && before=$key && key=
  case $command:$before:$key in
)";
  for (const CLI::App* command : commands_of(program)) write_choices(out, *command);
  out << R"(  esac
  if [[ $choices ]]; then
    COMPREPLY=($(compgen -W "$choices" -- "$word"))
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ $option == --set && ! $key ]]; then
    compopt -o nospace 2>/dev/null
    COMPREPLY=($(compgen -W "$keys" -- "$word"))
  else
    compopt -o filenames 2>/dev/null
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -F _tofmap tofmap
)";
  return out.str();
}

}  // namespace tofmap::app
