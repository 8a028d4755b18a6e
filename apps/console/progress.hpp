// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace tofmap::app {

/// Tells on stderr how far work has come that takes more than two seconds: on a terminal one line
/// that renews itself, elsewhere a line every few seconds, nothing when quiet.
class Progress {
 public:
  /// `total` is not known of devices.
  Progress(std::string what, std::optional<int> total, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `remark` follows the numbers, if there is any.
  void show(int done, const std::string& remark = "");

 private:
  using Clock = std::chrono::steady_clock;

  std::string bar(int done) const;
  std::string numbers(int done, double seconds) const;

  std::string what_;
  std::optional<int> total_;
  bool is_quiet_;
  bool is_terminal_;
  bool has_line_ = false;  ///< on a terminal, which is to be ended
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace tofmap::app
