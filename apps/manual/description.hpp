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

/// What the program tells of its command line, for its manual.
namespace tofmap::app {

std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// Those that are not given by their place.
std::vector<const CLI::Option*> named_options(const CLI::App& command);

std::vector<const CLI::Option*> positionals(const CLI::App& command);

/// The options that a command takes by --set; none if it does not take that.
std::vector<OptionText> settings_of(const CLI::App& command);

/// The values that an option is limited to; empty if there are none such.
std::vector<std::string> choices_of(const CLI::Option& option);

/// Those of a setting.
std::vector<std::string> choices_of(const OptionText& setting);

/// What a setting may be, with its unit.
std::string limits(const OptionText& setting);

}  // namespace tofmap::app
