// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace tofmap::app {

/// Tells on stderr how far a run has come: one line that renews itself on a terminal, nothing
/// elsewhere or when quiet.
class Progress {
 public:
  Progress(std::string what, std::optional<int> total, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `remark` follows the numbers, if there is any.
  void show(int done, const std::string& remark = "");

 private:
  std::string what_;
  std::optional<int> total_;
  bool is_shown_ = false;
  bool has_line_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace tofmap::app
