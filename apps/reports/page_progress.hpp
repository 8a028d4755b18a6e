// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "console/interruption.hpp"
#include "console/progress.hpp"

namespace tofmap::app {

/// Shows the progress of making a page, counted in frames.
class PageProgress {
 public:
  PageProgress(std::size_t frames, bool quiet)
      : progress_("report.html, frame", static_cast<int>(frames), quiet) {}

  /// To be called before each frame. Throws Interrupted.
  void next_frame() {
    stop_if_interrupted();
    progress_.show(done_++);
  }

 private:
  Progress progress_;
  int done_ = 0;
};

}  // namespace tofmap::app
