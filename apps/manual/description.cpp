// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "manual/description.hpp"

#include "options/options.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include <CLI/CLI.hpp>

namespace tofmap::app {
namespace {

/// The words of "a,b,c" or "a | b | c".
std::vector<std::string> words_of(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == '|'; }, ' ');
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<OptionText> settings_of(const CLI::App& command) {
  if (command.get_option_no_throw("--set") == nullptr) return {};
  ProgramOptions options;
  return option_table(command.get_name(), options).texts();
}

/// The choices are part of the type name: "TEXT:{a,b,c}".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return words_of(type.substr(begin + 1, end - begin - 1));
}

std::vector<std::string> choices_of(const OptionText& setting) {
  const bool is_choice = setting.allowed.find(" | ") != std::string::npos;
  return is_choice ? words_of(setting.allowed) : std::vector<std::string>{};
}

std::string limits(const OptionText& setting) {
  return setting.allowed + (setting.unit.empty() ? "" : ", " + setting.unit);
}

}  // namespace tofmap::app
