// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual.hpp"

#include "command.hpp"
#include "options/options.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// Those that are not given by their place.
std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

/// The options that a command takes by --set; none if it does not take that.
std::vector<OptionText> settings_of(const CLI::App& command) {
  if (command.get_option_no_throw("--set") == nullptr) return {};
  ProgramOptions options;
  return option_table(command.get_name(), options).texts();
}

/// The letters of a text in UTF-8, a number each.
std::vector<unsigned> code_points(const std::string& text) {
  std::vector<unsigned> points;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool goes_on = (byte & 0xC0) == 0x80;
    if (goes_on && !points.empty()) {
      points.back() = points.back() << 6 | (byte & 0x3F);
    } else {
      const unsigned bits = byte < 0x80 ? 0x7F : byte < 0xE0 ? 0x1F : byte < 0xF0 ? 0x0F : 0x07;
      points.push_back(byte & bits);
    }
  }
  return points;
}

/// A line of text as roff takes it.
std::string roff(const std::string& text) {
  std::string out = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const unsigned point : code_points(text)) {
    if (point == '\\') {
      out += "\\e";
    } else if (point == '-') {
      out += "\\-";
    } else if (point < 0x80) {
      out += static_cast<char>(point);
    } else {
      out += formatted("\\[u%04X]", point);
    }
  }
  return out;
}

std::string name_of(const CLI::Option& positional) { return positional.get_name(true); }

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The values that an option is limited to, as its type tells them ("{a,b,c}"), separated by
/// spaces; empty if there are none.
std::string choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string choices = type.substr(begin + 1, end - begin - 1);
  std::ranges::replace(choices, ',', ' ');
  return choices;
}

/// Those of a setting ("a | b | c").
std::string choices_of(const OptionText& setting) {
  std::string choices = setting.allowed;
  if (choices.find(" | ") == std::string::npos) return "";
  std::erase(choices, '|');
  return choices;
}

void write_command(std::ostream& out, const CLI::App& command) {
  out << ".SS " << roff("tofmap " + command.get_name());
  for (const CLI::Option* positional : positionals(command)) {
    const bool is_required = positional->get_required();
    out << ' ' << (is_required ? "" : "[") << roff(name_of(*positional))
        << (is_required ? "" : "]");
  }
  out << " [options]\n" << roff(command.get_description()) << ".\n";
  for (const CLI::Option* positional : positionals(command)) {
    out << ".TP\n.I " << roff(name_of(*positional)) << '\n'
        << roff(positional->get_description()) << '\n';
  }
  for (const CLI::Option* option : named_options(command)) {
    out << ".TP\n.B " << roff(option->get_name()) << (takes_value(*option) ? " \\fIVALUE\\fR" : "")
        << '\n'
        << roff(option->get_description()) << '\n';
  }
}

std::string limits(const OptionText& option) {
  return option.allowed + (option.unit.empty() ? "" : ", " + option.unit);
}

/// The commands that have a group of options.
std::vector<std::string> commands_with(const std::string& group) {
  std::vector<std::string> names;
  for (const std::string& name : commands_with_options()) {
    ProgramOptions options;
    const std::vector<OptionText> texts = option_table(name, options).texts();
    if (std::ranges::find(texts, group, &OptionText::group) != texts.end()) names.push_back(name);
  }
  return names;
}

/// A | ends the cell of a table.
std::string cell(std::string text) {
  for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2)) {
    text.insert(i, "\\");
  }
  return text;
}

/// What options and settings that are limited to some values may be, as cases of bash.
std::string choice_cases(const CLI::App& program) {
  std::ostringstream out;
  const auto add = [&](const std::string& pattern, const std::string& choices) {
    if (!choices.empty()) out << "    " << pattern << ") choices=\"" << choices << "\" ;;\n";
  };
  for (const CLI::App* command : commands_of(program)) {
    const std::string& name = command->get_name();
    for (const CLI::Option* option : named_options(*command)) {
      for (const std::string& word : option->get_lnames()) {
        add(name + ":--" + word + ":", choices_of(*option));
      }
    }
    for (const CLI::Option* positional : positionals(*command)) {
      add(name + ":" + name + ":", choices_of(*positional));
    }
  }
  ProgramOptions options;
  for (const OptionText& setting : option_table("", options).texts()) {
    add("*:" + setting.key(), choices_of(setting));
  }
  return out.str();
}

}  // namespace

std::string manual_page(const CLI::App& program) {
  std::ostringstream out;
  out << ".TH TOFMAP 1 \"\" \"tofmap " << TOFMAP_VERSION << "\" \"User Commands\"\n"
      << ".SH NAME\ntofmap \\- " << roff(program.get_description()) << '\n'
      << ".SH SYNOPSIS\n.B tofmap\n.I command\n[options]\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(program)) write_command(out, *command);
  out << ".SH SETTINGS\nOptions that\n.B \\-\\-set\nand a file for\n.B \\-\\-config\ntake; "
         "defaults in parentheses. A command has those of the groups that it uses: \\(aqtofmap "
         "config COMMAND\\(aq prints them.\n";
  ProgramOptions options;
  for (const OptionText& option : option_table("", options).texts()) {
    out << ".TP\n.B " << roff(option.key()) << " \\fR(" << roff(option.value) << ")\n"
        << roff(option.meaning) << " [" << roff(limits(option)) << "]\n";
  }
  out << ".SH EXIT STATUS\n"
         ".TP\n0\ndone\n.TP\n1\na fault of the program itself\n.TP\n2\nwrong use\n.TP\n3\nbad "
         "input\n.TP\n130\ninterrupted; what was finished is kept\n";
  return out.str();
}

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
  for (const CLI::App* command : commands_of(program)) {
    std::vector<std::string> options;
    for (const CLI::Option* option : named_options(*command)) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    }
    std::vector<std::string> keys;
    for (const OptionText& option : settings_of(*command)) keys.push_back(option.key() + "=");
    out << "    " << command->get_name() << ")\n      options=\"" << joined(options, " ")
        << "\"\n      keys=\"" << joined(keys, " ") << "\" ;;\n";
  }
  // A setting and its value are three words, with = between.
  out << R"(  esac
  for ((i = COMP_CWORD - 1; i > 1; i--)); do
    [[ ${COMP_WORDS[i]} == -* ]] && option=${COMP_WORDS[i]} && break
  done
  local before=${COMP_WORDS[COMP_CWORD - 1]} key= choices=
  [[ $word == = ]] && key=$before && word=
  [[ $before == = ]] && key=${COMP_WORDS[COMP_CWORD - 2]}
  [[ $key == --* ]] && before=$key && key=
  case $command:$before:$key in
)" << choice_cases(program)
      << R"(  esac
  if [[ $choices ]]; then
    COMPREPLY=($(compgen -W "$choices" -- "$word"))
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [[ $option == --set && $word != = && ${COMP_WORDS[COMP_CWORD - 1]} != = ]]; then
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

std::string option_reference() {
  std::ostringstream out;
  out << "# Options\n\nEvery option of `--set group.name=value` and of a file for `--config`, as "
         "`tofmap manual options` prints\nthem. `tofmap config COMMAND` prints those of a command "
         "as YAML that can be fed back.\n";
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

void add_manual_command(CLI::App& program, Outcome& /*outcome*/) {
  auto what = std::make_shared<std::string>("page");
  CLI::App* app = program.add_subcommand(
      "manual", "print the manual page, the completion for bash, or the table of all options");
  app->add_option("WHAT", *what, "page: for 'man -l -'; bash: for 'source'; options: Markdown")
      ->check(CLI::IsMember({"page", "bash", "options"}));
  app->callback([what, &program] {
    const std::string text = *what == "page"   ? manual_page(program)
                             : *what == "bash" ? bash_completion(program)
                                               : option_reference();
    std::fputs(text.c_str(), stdout);
  });
}

}  // namespace tofmap::app
