// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual/description.hpp"
#include "manual/manual.hpp"
#include "options/options.hpp"

#include <ostream>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

/// The Unicode code points of a UTF-8 text.
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

/// A line of text with the characters escaped that are special in roff.
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
      out += fmt::format("\\[u{:04X}]", point);
    }
  }
  return out;
}

std::string name_of(const CLI::Option& positional) { return positional.get_name(true); }

/// The value that follows an option in the manual: empty for a flag, else its choices or VALUE.
std::string value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::vector<std::string> choices = choices_of(option);
  return " \\fI" + (choices.empty() ? "VALUE" : roff(joined(choices, "|"))) + "\\fR";
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
    out << ".TP\n.B " << roff(option->get_name()) << value_of(*option) << '\n'
        << roff(option->get_description()) << '\n';
  }
}

}  // namespace

std::string manual_page(const CLI::App& program) {
  std::ostringstream out;
  out << ".TH TOFMAP 1 \"\" \"tofmap " << TOFMAP_VERSION << "\" \"User Commands\"\n"
      << ".SH NAME\ntofmap \\- " << roff(program.get_description()) << '\n'
      << ".SH SYNOPSIS\n.B tofmap\n.I command\n[options]\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(program)) write_command(out, *command);
  out << ".SH SETTINGS\nThe options for\n.B \\-\\-set\nand for the file of\n.B "
         "\\-\\-config\nwith their defaults in parentheses. Each command has some of them: "
         "\\(aqtofmap config COMMAND\\(aq prints these.\n";
  ProgramOptions options;
  for (const OptionText& option : option_table("", options).texts()) {
    out << ".TP\n.B " << roff(option.key()) << " \\fR(" << roff(option.value) << ")\n"
        << roff(option.meaning) << " [" << roff(limits(option)) << "]\n";
  }
  out << ".SH EXIT STATUS\n"
         ".TP\n0\ndone\n.TP\n1\nan error in the program itself\n.TP\n2\nwrong usage or options\n"
         ".TP\n3\nbad or missing input, or an output that cannot be written\n"
         ".TP\n130\ninterrupted; finished work is kept\n";
  return out.str();
}

}  // namespace tofmap::app
