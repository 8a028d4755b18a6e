// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tofmap::app {

/// The manual page of a program with commands, for man(1).
std::string manual_page(const CLI::App& program);

/// A script that has bash complete commands, their options, and the keys of --set.
std::string bash_completion(const CLI::App& program);

/// Every option of --set and --config as Markdown, a table a group.
std::string option_reference();

}  // namespace tofmap::app
