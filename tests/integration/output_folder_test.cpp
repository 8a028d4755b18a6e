// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <algorithm>
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
    EXPECT_THAT(finished.err, HasSubstr("is writable")) << command;
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
  expect_refusal(out_, "not a result of tofmap");
  EXPECT_EQ(read_text(out_ / "thesis.txt"), "mine");
}

TEST_F(OutputFolder, OfAResultWithFilesOfOthersIsKept) {
  ASSERT_EQ(run("unwrap").status, 0);
  std::ofstream(out_ / "thesis.txt") << "mine";
  expect_refusal(out_, "holds thesis.txt, which tofmap did not write");
  EXPECT_EQ(read_text(out_ / "thesis.txt"), "mine");
}

TEST_F(OutputFolder, WithFilesOfOthersInItsFoldersIsKept) {
  ASSERT_EQ(run("unwrap", {"--set", "pictures.frames=1"}).status, 0);
  const std::vector<fs::path> places{"range/notes.txt", "pictures/mine.png",
                                     "pictures/deep/deeper/mine.txt", "my photos/one.png"};
  for (const fs::path& place : places) {
    fs::create_directories((out_ / place).parent_path());
    std::ofstream(out_ / place) << "mine";
    const std::string named = place.begin()->string() == "my photos"       ? "my photos"
                              : place.parent_path().filename() == "deeper" ? "pictures/deep"
                                                                           : place.string();
    expect_refusal(out_, "holds " + named + ", which tofmap did not write");
    EXPECT_EQ(read_text(out_ / place), "mine");
    fs::remove(out_ / place);
  }
  fs::remove_all(out_ / "pictures" / "deep");
  fs::remove_all(out_ / "my photos");
  EXPECT_EQ(run("unwrap").status, 0) << "nothing of others is left";
}

TEST_F(OutputFolder, WithAFileThatWasChangedIsKept) {
  ASSERT_EQ(run("map").status, 0);
  const std::string trajectory = read_text(out_ / "trajectory.txt");
  std::string corrected = trajectory;
  corrected.back() = ' ';  // of the same size
  std::ofstream(out_ / "trajectory.txt") << corrected;
  expect_refusal(out_, "holds trajectory.txt, which was changed since tofmap wrote it");
  EXPECT_EQ(read_text(out_ / "trajectory.txt"), corrected);
  std::ofstream(out_ / "trajectory.txt") << trajectory;
  EXPECT_EQ(run("map").status, 0);
}

TEST_F(OutputFolder, WithLinksOfOthersIsKeptAsIsWhatTheyLeadTo) {
  ASSERT_EQ(run("unwrap").status, 0);
  const fs::path photos = folder_.path() / "photos";
  fs::create_directory(photos);
  std::ofstream(photos / "one.png") << "mine";
  fs::create_directory_symlink(photos, out_ / "range" / "photos");
  expect_refusal(out_, "holds range/photos, which tofmap did not write");
  fs::remove(out_ / "range" / "photos");
  fs::rename(out_ / "wraps", folder_.path() / "elsewhere");
  fs::create_directory_symlink(folder_.path() / "elsewhere", out_ / "wraps");
  expect_refusal(out_, "holds wraps, which was changed");
  EXPECT_EQ(read_text(photos / "one.png"), "mine");
  EXPECT_EQ(names_in(folder_.path() / "elsewhere").size(), frames);
}

TEST_F(OutputFolder, OfAResultThatDoesNotListItsFilesIsKept) {
  ASSERT_EQ(run("unwrap").status, 0);
  for (const std::string text : {"", "no list\n", "# tofmap wrote\n"}) {
    std::ofstream(out_ / ".tofmap-files") << text;
    expect_refusal(out_, "a result without its list of files");
  }
  fs::remove(out_ / ".tofmap-files");
  expect_refusal(out_, "a result without its list of files");
}

TEST_F(OutputFolder, ThatIsReadOnlyIsKept) {
  ASSERT_EQ(run("unwrap").status, 0);
  for (const fs::path& folder : {out_, out_ / "range"}) {
    fs::permissions(folder, fs::perms::owner_write, fs::perm_options::remove);
    expect_refusal(out_, folder.string() + ": is read-only");
    fs::permissions(folder, fs::perms::owner_write, fs::perm_options::add);
  }
  EXPECT_EQ(run("unwrap").status, 0);
}

TEST_F(OutputFolder, ThatIsAMountPointIsRefusedAtOnce) {
  const Finished finished = run_program({"unwrap", sequence_.string(), "--out", "/proc"});
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("/proc: is a mount point"));
  EXPECT_THAT(finished.err, HasSubstr("for example /proc/result"));
}

TEST_F(OutputFolder, BehindALinkIsWrittenAndTheLinkStays) {
  const fs::path disk = folder_.path() / "disk";
  fs::create_directory(disk);
  fs::create_directory_symlink(disk, out_);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(run("unwrap").status, 0);
    EXPECT_TRUE(fs::is_symlink(out_));
    EXPECT_TRUE(fs::exists(disk / "report.json"));
  }
  std::ofstream(disk / "range" / "mine.txt") << "mine";
  expect_refusal(out_, "holds range/mine.txt");
}

TEST_F(OutputFolder, BehindALinkThatLeadsNowhereIsRefused) {
  fs::create_directory_symlink(folder_.path() / "gone", out_);
  expect_refusal(out_, "is a link to");
  EXPECT_TRUE(fs::is_symlink(out_));
}

TEST_F(OutputFolder, OfARunThatWasKilledBeforeItsPageWasThereIsReplaced) {
  // The list names what comes before it is moved there.
  ASSERT_EQ(run("map", {"--set", "pictures.frames=1"}).status, 0);
  fs::remove(out_ / "report.html");
  fs::remove_all(out_ / "pictures");
  EXPECT_EQ(run("map").status, 0);
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
  expect_refusal(sequence_, "is or contains a recording");
  EXPECT_EQ(names_in(sequence_), before);
}

TEST_F(OutputFolder, ThatHoldsTheRecordingIsKept) {
  // An earlier result by its look, so it would be replaced with all that is in it.
  std::ofstream(folder_.path() / "options.yaml") << "threads: 0\n";
  expect_refusal(folder_.path(), "is or contains a recording");
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
  // Clang's OpenMP needs 1024 bytes of shared memory, which count as a file.
  constexpr std::size_t max_file_bytes = 2000;
  for (const std::string command : {"unwrap", "map"}) {
    const Finished finished = run_program({command, sequence_.string(), "--out", out_.string()},
                                          {.max_file_bytes = max_file_bytes});
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
  EXPECT_THAT(finished.err, HasSubstr("is complete, but without pictures: "));
  EXPECT_THAT(names_in(out_), ElementsAre(".tofmap-files", "confidence", "options.yaml", "range",
                                          "reason", "report.json", "wraps"));
  EXPECT_EQ(run("unwrap").status, 0) << "what is there can be replaced";
}

TEST_F(FullDisk, KeepsTheMapWhenItsMeshOrPageDoesNotFit) {
  const auto map = [&](std::size_t most_bytes) {
    return run_program({"map", sequence_.string(), "--out", out_.string(), "--set",
                        "pictures.frames=0", "--set", "report.frames=1"},
                       {.max_file_bytes = most_bytes});
  };
  ASSERT_EQ(map(0).status, 0);
  const auto size = [&](const std::string& name) { return fs::file_size(out_ / name); };
  ASSERT_LT(std::max(size("map.ply"), size("report.json")), size("mesh.ply") / 2);
  const Finished without_mesh = map(size("mesh.ply") / 2);
  EXPECT_EQ(without_mesh.status, 3);
  EXPECT_THAT(without_mesh.err, HasSubstr("holds the map, but without mesh.ply: "));
  EXPECT_THAT(without_mesh.err, HasSubstr("is complete, but without report.html: "));
  EXPECT_TRUE(fs::exists(out_ / "map.ply") && fs::exists(out_ / "trajectory.txt"));
  EXPECT_FALSE(fs::exists(out_ / "mesh.ply")) << "a part of it";
  EXPECT_THAT(without_mesh.err, HasSubstr("holds the map, but without map.db: "));
  EXPECT_FALSE(fs::exists(out_ / "map.db"));
  EXPECT_EQ(read_json(out_ / "report.json")["failed"].size(), 2U);
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"out", "seq"}));
}

TEST_F(FullDisk, KeepsMapAndPathAsideWhenTheRestDoesNotFit) {
  const Finished finished = run("map", {"--set", "map.voxel_m=1"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  const auto size = [&](const std::string& name) { return fs::file_size(out_ / name); };
  const std::size_t enough = std::max(size("map.ply"), size("trajectory.txt"));
  ASSERT_LT(enough, size("report.json"));
  fs::remove_all(out_);
  const Finished full =
      run_program({"map", sequence_.string(), "--out", out_.string(), "--set", "map.voxel_m=1"},
                  {.max_file_bytes = enough});
  EXPECT_EQ(full.status, 3);
  const fs::path kept = unfinished_result(folder_.path());
  ASSERT_FALSE(kept.empty());
  EXPECT_THAT(full.err, HasSubstr("map and path are kept in " + kept.string()));
  EXPECT_TRUE(fs::exists(kept / "map.ply") && fs::exists(kept / "trajectory.txt"));
  EXPECT_FALSE(fs::exists(out_));
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
