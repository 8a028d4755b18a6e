// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap::app {

/// From here on the first Ctrl-C (or SIGTERM) is only noted, for commands to finish cleanly;
/// the second one ends the program at once.
void watch_for_interruption();

/// True once the user wants to stop.
bool is_interrupted();

}  // namespace tofmap::app
