// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "interruption.hpp"

#include <csignal>

namespace tofmap::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_interruption(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interruption() {
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
}

bool is_interrupted() { return interrupted != 0; }

}  // namespace tofmap::app
