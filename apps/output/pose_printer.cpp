// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/pose_printer.hpp"

#include <csignal>
#include <iostream>

#include <tofmap/core/trajectory.hpp>

namespace tofmap::app {

PosePrinter::PosePrinter() { std::signal(SIGPIPE, SIG_IGN); }

bool PosePrinter::print_new(std::span<const RegisteredFrame* const> localised,
                            const KeyframeGraph& keyframes) {
  for (const RegisteredFrame* frame : localised) {
    if (!printed_.insert(frame->index).second) continue;
    write_pose(std::cout, {frame->timestamp_s, pose_of(*frame, keyframes)});
  }
  return static_cast<bool>(std::cout.flush());
}

}  // namespace tofmap::app
