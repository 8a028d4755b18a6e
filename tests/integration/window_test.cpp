// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"
#include "virtual_display.hpp"

#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <support/waiting.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Text alone has a few grays; a map coloured by height has many colours.
constexpr int colors_of_a_map = 100;

class ProgramWindow : public WithRecording {
 protected:
  void SetUp() override {
    if (!display_.is_there()) GTEST_SKIP() << "Xvfb is missing: install the package xvfb";
    WithRecording::SetUp();
  }

  std::vector<std::string> mapping() const {
    return {"map",   sequence_.string(),      "--out", out_.string(), "--view",
            "--set", "map.min_observations=1"};
  }

  VirtualDisplay display_;
  const std::string title_ = "tofmap " + sequence_.string();
};

TEST_F(ProgramWindow, ShowsTheMapUntilItIsClosed) {
  RunningProgram program(mapping());
  ASSERT_TRUE(display_.has_window(title_));
  EXPECT_TRUE(comes_true([&] { return fs::exists(out_ / "map.ply"); }));
  EXPECT_TRUE(comes_true([&] { return display_.count_colors() > colors_of_a_map; }));
  EXPECT_FALSE(program.has_ended());
  EXPECT_TRUE(display_.close_by("q", title_));
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_TRUE(fs::exists(out_ / "pictures"));
}

TEST_F(ProgramWindow, ClosedEarlyDoesNotEndTheWork) {
  RunningProgram program(mapping());
  ASSERT_TRUE(display_.has_window(title_));
  EXPECT_TRUE(display_.close_by("Escape", title_));
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_EQ(read_json(out_ / "report.json")["frames"].size(), frames);
}

TEST_F(ProgramWindow, GoesWhenTheProgramIsInterrupted) {
  RunningProgram program(mapping());
  EXPECT_TRUE(comes_true([&] { return fs::exists(out_ / "report.html"); }));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().status, 0) << "the result is whole";
}

TEST_F(ProgramWindow, TellsWhyWorkBesideItFailed) {
  fs::remove_all(sequence_ / "phase_b");
  const Finished finished = run_program(mapping());
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("phase_b"));
}

TEST_F(ProgramWindow, ViewsAMap) {
  ASSERT_EQ(run("map", {"--set", "map.min_observations=1"}).status, 0);
  RunningProgram program({"view", out_.string()});
  ASSERT_TRUE(display_.has_window(out_.string()));
  EXPECT_TRUE(comes_true([&] { return display_.count_colors() > colors_of_a_map; }));
  EXPECT_TRUE(display_.close_by("q", out_.string()));
  EXPECT_EQ(program.wait().status, 0);
}

TEST_F(ProgramWindow, ShowsAMapInSeveralWays) {
  ASSERT_EQ(run("map", {"--set", "map.min_observations=1"}).status, 0);
  RunningProgram program({"view", out_.string()});
  ASSERT_TRUE(display_.has_window(out_.string()));
  EXPECT_TRUE(comes_true([&] { return display_.count_colors() > colors_of_a_map; }));
  for (const char* key : {"c", "f", "p", "h", "2", "1"}) {
    EXPECT_TRUE(display_.changes_by(key, out_.string())) << key;
  }
  EXPECT_TRUE(display_.close_by("q", out_.string()));
  EXPECT_EQ(program.wait().status, 0);
}

TEST_F(ProgramWindow, GoesFromOneMethodOfAnEvaluationToTheNext) {
  ASSERT_EQ(
      run("evaluate", {"--set", "evaluation.methods=none pixel", "--set", "map.min_observations=1"})
          .status,
      0);
  RunningProgram program({"view", out_.string()});
  ASSERT_TRUE(display_.has_window(out_.string()));
  EXPECT_TRUE(comes_true([&] { return display_.count_colors() > colors_of_a_map; }));
  for (const char* key : {"m", "m"}) {
    EXPECT_TRUE(display_.changes_by(key, out_.string())) << key;
  }
  EXPECT_TRUE(display_.close_by("q", out_.string()));
  EXPECT_EQ(program.wait().status, 0);
}

TEST_F(ProgramWindow, StepsThroughARecording) {
  fs::remove(sequence_ / "phase_b" / "000002.png");  // a damaged frame is passed through
  RunningProgram program({"view", sequence_.string(), "--color", "range"});
  ASSERT_TRUE(display_.has_window(sequence_.string()));
  EXPECT_TRUE(comes_true([&] { return display_.count_colors() > colors_of_a_map; }));
  for (const char* key : {"Right", "Right", "Right", "u", "x", "c", "Left"}) {
    EXPECT_TRUE(display_.changes_by(key, sequence_.string())) << key;
  }
  EXPECT_TRUE(display_.close_by("q", sequence_.string()));
  EXPECT_EQ(program.wait().status, 0);
}

TEST_F(ProgramWindow, OfAViewGoesWhenTheProgramIsInterrupted) {
  RunningProgram program({"view", sequence_.string()});
  ASSERT_TRUE(display_.has_window(sequence_.string()));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().status, 130);
}

using ProgramWithoutDisplay = WithRecording;

TEST_F(ProgramWithoutDisplay, RefusesToViewBeforeItWorks) {
  unsetenv("DISPLAY");
  const Finished finished = run("map", {"--view"});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("no display"));
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace tofmap::test
