// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// The recording's frames over and over, enough for a run to last until it is interrupted.
class Interruption : public WithRecording {
 protected:
  static constexpr int many = 3000;

  void SetUp() override {
    WithRecording::SetUp();
    std::ofstream list(sequence_ / "frames.txt");
    for (int i = 0; i < many; ++i) {
      const std::string name = "/" + std::to_string(1000000 + i).substr(1) + ".png";
      const std::string source = "00000" + std::to_string(i % frames) + ".png";
      list << i / 15.0;
      for (const std::string folder : {"phase_a", "phase_b", "amplitude_a", "amplitude_b"}) {
        list << ' ' << folder << name;
        if (i >= frames) fs::create_symlink(source, sequence_ / (folder + name));
      }
      list << '\n';
    }
  }

  fs::path partial_folder() const {
    for (const std::string& name : names_in(folder_.path())) {
      if (name.starts_with("out.partial-")) return folder_.path() / name;
    }
    return {};
  }

  /// Waits until unwrapping has written a frame; false if it never does.
  bool has_begun(RunningProgram& program) const {
    for (int i = 0; i < 6000 && !program.has_ended(); ++i) {
      const fs::path folder = partial_folder();
      if (fs::exists(folder / "range" / "000000.png")) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  std::vector<std::string> unwrap_arguments() const {
    return {"unwrap", sequence_.string(), "--out", out_.string(), "--method", "pixel"};
  }
};

TEST_F(Interruption, KeepsTheFramesThatAreFinished) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunningProgram program(unwrap_arguments());
    ASSERT_TRUE(has_begun(program));
    program.send(signal);
    const Finished finished = program.wait();
    EXPECT_EQ(finished.status, 130) << finished.err;
    const auto report = read_json(out_ / "report.json");
    EXPECT_EQ(report["summary"]["interrupted"], true);
    const std::size_t kept = report["frames"].size();
    EXPECT_GT(kept, 0U);
    EXPECT_LT(kept, static_cast<std::size_t>(many));
    EXPECT_EQ(names_in(out_ / "range").size(), kept);
    EXPECT_EQ(names_in(out_ / "wraps").size(), kept);
    EXPECT_TRUE(partial_folder().empty());
  }
}

TEST_F(Interruption, OfAMapKeepsTheMapSoFar) {
  RunningProgram program({"map", sequence_.string(), "--out", out_.string()});
  for (int i = 0; i < 3000 && partial_folder().empty(); ++i) std::this_thread::sleep_for(10ms);
  std::this_thread::sleep_for(300ms);  // some frames; none would do as well
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  EXPECT_EQ(read_json(out_ / "report.json")["summary"]["interrupted"], true);
  EXPECT_TRUE(fs::exists(out_ / "map.ply"));
}

TEST_F(Interruption, ByKillLeavesNoResultAndAnotherRunWorks) {
  {
    RunningProgram program(unwrap_arguments());
    ASSERT_TRUE(has_begun(program));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().status, 128 + SIGKILL);
  }
  EXPECT_FALSE(fs::exists(out_)) << "a half result looks whole";
  std::ofstream(sequence_ / "frames.txt") << "0.0 phase_a/000000.png phase_b/000000.png\n";
  EXPECT_EQ(run("unwrap").status, 0);
}

}  // namespace
}  // namespace tofmap::test
