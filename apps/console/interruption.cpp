// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "console/interruption.hpp"

#include <atomic>
#include <csignal>

namespace tofmap::app {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // required in a signal handler

extern "C" void note_interruption(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interruption() {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit becomes a write error
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
}

bool is_interrupted() { return interrupted; }

void stop_if_interrupted() {
  if (interrupted) throw Interrupted();
}

void count_interruptions_anew() {
  interrupted = false;
  watch_for_interruption();
}

}  // namespace tofmap::app
