// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support/temporary_folder.hpp>
#include <sys/types.h>

namespace tofmap::test {

/// How a run of the program ended, and what it said.
struct Finished {
  int status = -1;  ///< exit status; 128 + signal if a signal ended it
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

/// Limits under which the program runs.
struct RunLimits {
  /// No file can grow beyond this, as on a full disk; 0: no limit.
  std::size_t max_file_bytes = 0;
};

/// The built program, started with these arguments and not waited for.
class RunningProgram {
 public:
  RunningProgram(const std::vector<std::string>& arguments, const RunLimits& limits = {});
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram();

  void send(int signal) const;
  bool has_ended();
  Finished wait();

 private:
  TemporaryFolder texts_;  ///< holds what it says; pipes would fill up
  pid_t pid_ = -1;         ///< -1 once it has ended
  int wait_status_ = 0;
};

/// Runs the built program as a user would.
Finished run_program(const std::vector<std::string>& arguments, const RunLimits& limits = {});

std::string read_text(const std::filesystem::path& file);
nlohmann::json read_json(const std::filesystem::path& file);

/// Names of what a folder holds, sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// The folder that a run whose result is to be `out` there fills meanwhile; empty if there is none.
std::filesystem::path unfinished_result(const std::filesystem::path& folder);

/// A small simulated recording of a room, and a place for results beside it.
class WithRecording : public testing::Test {
 protected:
  static constexpr int frames = 4;

  void SetUp() override;

  /// Runs `command SEQ --out OUT` and more arguments; without pictures of frames, which take most
  /// of the time, unless they are asked for.
  Finished run(const std::string& command, const std::vector<std::string>& more = {}) const;

  /// Replaces the first `old_text` in a file of the recording.
  void edit(const std::string& file, const std::string& old_text,
            const std::string& new_text) const;

  TemporaryFolder folder_;
  std::filesystem::path sequence_ = folder_.path() / "seq";
  std::filesystem::path out_ = folder_.path() / "out";
};

}  // namespace tofmap::test
