// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "progress.hpp"

#include <cstdio>

#include <unistd.h>

namespace tofmap::app {

Progress::Progress(std::string what, std::optional<int> total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      is_shown_(!quiet && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (has_line_) std::fputc('\n', stderr);
}

void Progress::show(int done, const std::string& remark) {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  const bool is_last = total_ && done == *total_;
  if (!is_shown_ || (now - last_ < 200ms && !is_last)) return;
  last_ = now;
  has_line_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double rate = seconds > 0 ? done / seconds : 0;
  const std::string total = total_ ? " / " + std::to_string(*total_) : "";
  const std::string rest = remark.empty() ? "" : "; " + remark;
  std::fprintf(stderr, "\r%s %d%s (%.1f a second)%s\033[K", what_.c_str(), done, total.c_str(),
               rate, rest.c_str());
}

}  // namespace tofmap::app
