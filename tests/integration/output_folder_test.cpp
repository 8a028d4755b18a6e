// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <sys/wait.h>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

/// The program under a limit on the size of files, as on a full disk.
class FullDisk : public WithRecording {
 protected:
  void SetUp() override {
    if (TOFMAP_COVERAGE) GTEST_SKIP() << "coverage is written to files, too";
    WithRecording::SetUp();
  }
};

class OutputFolder : public WithRecording {
 protected:
  /// Expects status 3, the part in the message, and no partial folder.
  void expect_refusal(const fs::path& out, const std::string& part) const {
    for (const std::string command : {"unwrap", "map", "evaluate"}) {
      const Finished finished =
          run_program({command, sequence_.string(), "--out", out.string(), "--quiet"});
      EXPECT_EQ(finished.status, 3) << command;
      EXPECT_THAT(finished.err, HasSubstr(part)) << command;
      EXPECT_THAT(finished.err, HasSubstr("choose another output folder")) << command;
      for (const std::string& name : names_in(folder_.path())) {
        EXPECT_THAT(name, testing::Not(HasSubstr(".partial-"))) << command;
      }
    }
  }
};

TEST_F(FullDisk, OfStandardOutputIsNoSuccess) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const fs::path said = folder_.path() / "said";
  const std::string command =
      std::string(TOFMAP_PROGRAM) + " config map > /dev/full 2> " + said.string();
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_THAT(read_text(said), HasSubstr("is the disk full?"));
}

TEST_F(OutputFolder, IsMadeWithItsParents) {
  const fs::path deep = folder_.path() / "a" / "b" / "result";
  EXPECT_EQ(run_program({"unwrap", sequence_.string(), "--out", deep.string() + "/"}).status, 0);
  EXPECT_TRUE(fs::exists(deep / "report.json"));
}

TEST_F(OutputFolder, ThatCannotBeMadeIsNamedBeforeWorkBegins) {
  // Below a file nobody can make a folder, not even root, whom permissions do not stop.
  std::ofstream(folder_.path() / "file") << "x";
  const fs::path below = folder_.path() / "file" / "result";
  for (const std::string command : {"unwrap", "map", "evaluate"}) {
    const Finished finished = run_program({command, sequence_.string(), "--out", below.string()});
    EXPECT_EQ(finished.status, 3) << command;
    EXPECT_THAT(finished.err, HasSubstr(below.string())) << command;
    EXPECT_THAT(finished.err, HasSubstr("can be written")) << command;
  }
}

TEST_F(OutputFolder, MustHaveAName) {
  const Finished finished = run_program({"unwrap", sequence_.string(), "--out", ""});
  EXPECT_EQ(finished.status, 2);
  EXPECT_THAT(finished.err, HasSubstr("has no name"));
}

TEST_F(OutputFolder, ThatIsAFileIsKept) {
  std::ofstream(out_) << "mine";
  expect_refusal(out_, "is a file");
  EXPECT_EQ(read_text(out_), "mine");
}

TEST_F(OutputFolder, WithFilesOfOthersIsKept) {
  fs::create_directory(out_);
  std::ofstream(out_ / "thesis.txt") << "mine";
  expect_refusal(out_, "no result of tofmap");
  EXPECT_EQ(read_text(out_ / "thesis.txt"), "mine");
}

TEST_F(OutputFolder, OfAResultWithFilesOfOthersIsKept) {
  ASSERT_EQ(run("unwrap").status, 0);
  std::ofstream(out_ / "thesis.txt") << "mine";
  expect_refusal(out_, "holds thesis.txt, which no result of tofmap has");
  EXPECT_EQ(read_text(out_ / "thesis.txt"), "mine");
}

TEST_F(OutputFolder, OfAnyEarlierResultIsReplaced) {
  for (const std::string command : {"unwrap", "map", "evaluate"}) {
    ASSERT_EQ(run(command).status, 0) << command;
    ASSERT_EQ(run(command).status, 0) << command << ": its own, with pictures and page";
  }
  ASSERT_EQ(run("map", {"--pcd"}).status, 0);
  ASSERT_EQ(run("map").status, 0);
  const std::string simulated = (folder_.path() / "simulated").string();
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(run_program({"simulate", "wall", "--frames", "2", "--out", simulated}).status, 0);
  }
}

TEST_F(OutputFolder, ThatIsTheRecordingIsKept) {
  const auto before = names_in(sequence_);
  expect_refusal(sequence_, "is or holds a recording");
  EXPECT_EQ(names_in(sequence_), before);
}

TEST_F(OutputFolder, ThatHoldsTheRecordingIsKept) {
  // An earlier result by its look, so it would be replaced with all that is in it.
  std::ofstream(folder_.path() / "options.yaml") << "threads: 0\n";
  expect_refusal(folder_.path(), "is or holds a recording");
  EXPECT_TRUE(fs::exists(sequence_ / "sequence.yaml"));
}

TEST_F(OutputFolder, IsReplacedWholeByANewResult) {
  ASSERT_EQ(run("map").status, 0);
  ASSERT_TRUE(fs::exists(out_ / "map.ply"));
  ASSERT_EQ(run("unwrap").status, 0);
  EXPECT_FALSE(fs::exists(out_ / "map.ply")) << "of the earlier result";
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"out", "seq"}));
}

TEST_F(OutputFolder, KeepsTheEarlierResultWhenANewRunFails) {
  ASSERT_EQ(run("unwrap").status, 0);
  const std::string report = read_text(out_ / "report.json");
  for (int i = 0; i < 3; ++i) {
    fs::remove(sequence_ / "phase_a" / ("00000" + std::to_string(i) + ".png"));
  }
  EXPECT_EQ(run("unwrap").status, 3);
  EXPECT_EQ(read_text(out_ / "report.json"), report);
}

TEST_F(FullDisk, IsAnErrorThatNamesTheFileAndLeavesNothing) {
  for (const std::string command : {"unwrap", "map"}) {
    const Finished finished = run_program({command, sequence_.string(), "--out", out_.string()},
                                          {.max_file_bytes = 1000});
    EXPECT_EQ(finished.status, 3) << command;
    EXPECT_THAT(finished.err, HasSubstr("cannot be written")) << command;
    EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"seq"}) << command;
  }
}

TEST_F(FullDisk, KeepsTheResultWhenOnlyPicturesDoNotFit) {
  const Finished finished =
      run_program({"unwrap", sequence_.string(), "--out", out_.string()}, {.max_file_bytes = 5000});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("cannot be written"));
  EXPECT_THAT(names_in(out_),
              ElementsAre("confidence", "options.yaml", "range", "reason", "report.json", "wraps"));
}

TEST_F(FullDisk, IsAnErrorOfASimulationToo) {
  const Finished finished = run_program(
      {"simulate", "room", "--out", out_.string(), "--frames", "1"}, {.max_file_bytes = 1000});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("cannot be written"));
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"seq"});
}

}  // namespace
}  // namespace tofmap::test
