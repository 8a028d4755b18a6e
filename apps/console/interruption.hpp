// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap::app {

/// Catches the first Ctrl-C or SIGTERM from now on, so that commands can finish cleanly (see
/// is_interrupted). The second one ends the program at once.
void watch_for_interruption();

/// Whether Ctrl-C or SIGTERM has been caught.
bool is_interrupted();

/// Clears the interruption, so that the work from here on is interrupted only by another Ctrl-C.
void count_interruptions_anew();

/// Thrown by stop_if_interrupted, to abandon work that leaves no partial result.
struct Interrupted {};

/// Throws Interrupted if Ctrl-C or SIGTERM has been caught.
void stop_if_interrupted();

}  // namespace tofmap::app
