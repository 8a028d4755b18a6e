// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace tofmap::app {

/// Prints the progress of work that takes more than two seconds on stderr. On a terminal, one line
/// is updated in place; elsewhere, a line is printed every few seconds. Prints nothing if `quiet`.
class Progress {
 public:
  /// `what` names the steps ("mapping frame"). `total` is the number of steps, empty if it is
  /// unknown, as for a device.
  Progress(std::string what, std::optional<int> total, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line on the terminal.
  ~Progress();

  /// Shows that `done` steps are finished. `remark` follows the numbers.
  void show(int done, const std::string& remark = "");

 private:
  using Clock = std::chrono::steady_clock;

  std::string bar(int done) const;
  std::string numbers(int done, double seconds) const;

  std::string what_;
  std::optional<int> total_;
  bool is_quiet_;
  bool is_terminal_;
  bool has_line_ = false;  ///< whether a line on the terminal has yet to be ended
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace tofmap::app
