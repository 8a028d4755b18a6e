// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// Descriptions of the command line, from which the manual and the completion are made.
namespace tofmap::app {

/// The commands of the program.
std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// The arguments of a command that begin with "--".
std::vector<const CLI::Option*> named_options(const CLI::App& command);

/// The arguments of a command that are recognised by their position.
std::vector<const CLI::Option*> positionals(const CLI::App& command);

/// The options that a command takes by --set. Empty if it has no --set.
std::vector<OptionText> settings_of(const CLI::App& command);

/// The allowed values of a command line argument. Empty if it is not limited to some values.
std::vector<std::string> choices_of(const CLI::Option& option);

/// The allowed values of an option of --set. Empty if it is not limited to some values.
std::vector<std::string> choices_of(const OptionText& setting);

/// The range or the allowed values of an option of --set, with the unit.
std::string limits(const OptionText& setting);

}  // namespace tofmap::app
