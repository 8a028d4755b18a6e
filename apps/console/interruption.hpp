// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap::app {

/// From here on the first Ctrl-C (or SIGTERM) is only noted, for commands to finish cleanly;
/// the second one ends the program at once.
void watch_for_interruption();

/// True once the user wants to stop.
bool is_interrupted();

/// Forgets that the user wanted to stop: what is done from here on takes a further Ctrl-C to end.
void count_interruptions_anew();

/// Thrown where work that leaves nothing ends because the user wants to stop.
struct Interrupted {};

/// Throws Interrupted once the user wants to stop.
void stop_if_interrupted();

}  // namespace tofmap::app
