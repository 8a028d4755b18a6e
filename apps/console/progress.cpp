// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "console/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds unannounced = 2s;
constexpr std::chrono::milliseconds between_renewals = 200ms;
constexpr std::chrono::milliseconds between_lines = 5s;

/// A duration in words: "8 s", "3 min", "2 h 5 min".
std::string duration(double seconds) {
  const auto whole = [](double number) { return fmt::format("{:.0f}", number); };
  constexpr double minute = 60;
  constexpr double hour = 60 * minute;
  if (seconds < 2 * minute) return whole(std::ceil(seconds)) + " s";
  if (seconds < 2 * hour) return whole(seconds / minute) + " min";
  const double hours = std::floor(seconds / hour);
  return whole(hours) + " h " + whole(std::floor((seconds - hours * hour) / minute)) + " min";
}

std::size_t terminal_columns() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  constexpr std::size_t usual = 80;
  return is_known ? size.ws_col : usual;
}

}  // namespace

Progress::Progress(std::string what, std::optional<int> total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      is_quiet_(quiet),
      is_terminal_(isatty(STDERR_FILENO) != 0),
      next_(start_ + unannounced) {}

Progress::~Progress() {
  if (has_line_) std::fputc('\n', stderr);
}

/// Empty if the total is unknown.
std::string Progress::bar(int done) const {
  if (!total_ || *total_ <= 0) return "";
  constexpr int width = 20;
  const int filled = std::clamp(width * done / *total_, 0, width);
  return " [" + std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '.') + "]";
}

std::string Progress::numbers(int done, double seconds) const {
  std::string text = " " + std::to_string(done);
  if (total_) text += " of " + std::to_string(*total_);
  const double rate = done / seconds;
  text += fmt::format(", {:.{}f} a second", rate, rate < 10 ? 1 : 0);
  if (total_ && done > 0 && done < *total_)
    text += ", " + duration((*total_ - done) / rate) + " left";
  return text;
}

void Progress::show(int done, const std::string& remark) {
  const Clock::time_point now = Clock::now();
  const bool is_last = total_ && done == *total_ && has_line_;
  if (is_quiet_ || (now < next_ && !is_last)) return;
  next_ = now + (is_terminal_ ? between_renewals : between_lines);
  const std::string rest = numbers(done, std::chrono::duration<double>(now - start_).count()) +
                           (remark.empty() ? "" : "; " + remark);
  if (!is_terminal_) {
    std::fprintf(stderr, "%s%s\n", what_.c_str(), rest.c_str());
    return;
  }
  // A line longer than the terminal could not be overwritten.
  const std::string line = (what_ + bar(done) + rest).substr(0, terminal_columns() - 1);
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  has_line_ = true;
}

}  // namespace tofmap::app
