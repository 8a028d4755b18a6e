// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tofmap::test {
namespace fs = std::filesystem;
namespace {

/// In the child: gives one of its streams a file.
void redirect(int stream, const fs::path& file) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(descriptor, stream);
  close(descriptor);
}

void apply(const RunLimits& limits) {
  if (limits.max_file_bytes == 0) return;
  // Without the signal, writing beyond the limit fails as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{limits.max_file_bytes, limits.max_file_bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const RunLimits& limits) {
  std::vector<char*> argv{const_cast<char*>(TOFMAP_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const fs::path out = texts_.path() / "out";
  const fs::path err = texts_.path() / "err";
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot start a program");
  if (pid_ == 0) {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    apply(limits);
    execv(TOFMAP_PROGRAM, argv.data());
    _exit(127);
  }
}

RunningProgram::~RunningProgram() {
  if (has_ended()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void RunningProgram::send(int signal) const {
  if (pid_ > 0) kill(pid_, signal);
}

bool RunningProgram::has_ended() {
  if (pid_ > 0 && waitpid(pid_, &wait_status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ < 0;
}

Finished RunningProgram::wait() {
  if (pid_ > 0) waitpid(pid_, &wait_status_, 0);
  pid_ = -1;
  const int status =
      WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
  return {status, read_text(texts_.path() / "out"), read_text(texts_.path() / "err")};
}

Finished run_program(const std::vector<std::string>& arguments, const RunLimits& limits) {
  return RunningProgram(arguments, limits).wait();
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

nlohmann::json read_json(const fs::path& file) { return nlohmann::json::parse(read_text(file)); }

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

fs::path unfinished_result(const fs::path& folder) {
  for (const std::string& name : names_in(folder)) {
    if (name.starts_with("out.partial-")) return folder / name;
  }
  return {};
}

void WithRecording::SetUp() {
  const Finished simulated = run_program(
      {"simulate", "room", "--out", sequence_.string(), "--frames", std::to_string(frames), "--set",
       "simulator.width_px=44", "--set", "simulator.height_px=36"});
  ASSERT_EQ(simulated.status, 0) << simulated.err;
}

Finished WithRecording::run(const std::string& command,
                            const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{command, sequence_.string()};
  if (command != "info") arguments.insert(arguments.end(), {"--out", out_.string()});
  if (command != "info" && command != "simulate") {
    arguments.insert(arguments.end(), {"--set", "pictures.frames=0"});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

void WithRecording::edit(const std::string& file, const std::string& old_text,
                         const std::string& new_text) const {
  std::string text = read_text(sequence_ / file);
  const std::size_t at = text.find(old_text);
  ASSERT_NE(at, std::string::npos) << old_text << " is not in " << text;
  std::ofstream(sequence_ / file) << text.replace(at, old_text.size(), new_text);
}

}  // namespace tofmap::test
