// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>

namespace tofmap::app {

/// From here on the first Ctrl-C (or SIGTERM) is only noted, for commands to finish cleanly;
/// the second one ends the program at once.
void watch_for_interruption();

/// True once the user wants to stop.
bool is_interrupted();

/// Thrown where work that leaves nothing ends because the user wants to stop.
struct Interrupted {};

/// Throws Interrupted once the user wants to stop.
void stop_if_interrupted();

/// Adds to a result that is in place what it can do without, as pictures and a page are. Returns
/// the status of the command, which was `status` so far: interrupted if it is the user who ends
/// this, which is said. A run that was interrupted before is at an end here, so that a further
/// Ctrl-C counts anew.
int add_to_result(const std::filesystem::path& result, int status,
                  const std::function<void()>& add);

}  // namespace tofmap::app
