// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tofmap::app {

/// The manual page of the program, in roff for man(1).
std::string manual_page(const CLI::App& program);

/// A bash script that completes commands, their options, and the keys and values of --set.
std::string bash_completion(const CLI::App& program);

/// All options of --set and --config as Markdown, with one table per group.
std::string option_reference();

}  // namespace tofmap::app
