// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "console/interruption.hpp"

#include "command.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>

namespace tofmap::app {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);  // else no signal might set it

extern "C" void note_interruption(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interruption() {
  std::signal(SIGINT, note_interruption);
  std::signal(SIGTERM, note_interruption);
}

bool is_interrupted() { return interrupted; }

void stop_if_interrupted() {
  if (interrupted) throw Interrupted();
}

int add_to_result(const std::filesystem::path& result, int status,
                  const std::function<void()>& add) {
  if (status == exit_status::interrupted) {
    interrupted = false;
    watch_for_interruption();
  }
  try {
    add();
  } catch (const Interrupted&) {
    std::fprintf(stderr,
                 "tofmap: interrupted; %s is whole, but pictures or report.html are left out\n",
                 result.c_str());
    return exit_status::interrupted;
  }
  return status;
}

}  // namespace tofmap::app
