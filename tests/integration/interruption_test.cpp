// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <support/waiting.hpp>

namespace tofmap::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

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

  fs::path partial_folder() const { return unfinished_result(folder_.path()); }

  /// Waits until unwrapping has written a frame; false if it never does.
  bool has_begun(RunningProgram& program) const {
    return comes_true([&] {
             return program.has_ended() || fs::exists(partial_folder() / "range" / "000000.png");
           }) &&
           !program.has_ended();
  }

  void shorten_recording(std::size_t count) const {
    std::istringstream list(read_text(sequence_ / "frames.txt"));
    std::ofstream shorter(sequence_ / "frames.txt");
    std::string line;
    for (std::size_t i = 0; i < count && std::getline(list, line); ++i) shorter << line << '\n';
  }

  std::vector<std::string> unwrap_arguments() const {
    return {"unwrap", sequence_.string(), "--out", out_.string(), "--method", "pixel"};
  }
};

TEST_F(Interruption, LeavesAnEarlierResultWhereItIs) {
  RunningProgram first(unwrap_arguments());
  ASSERT_TRUE(has_begun(first));
  first.send(SIGINT);
  first.wait();
  const std::size_t earlier = names_in(out_ / "range").size();
  RunningProgram program(unwrap_arguments());
  ASSERT_TRUE(has_begun(program));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130);
  EXPECT_THAT(finished.err, HasSubstr("the earlier result in " + out_.string() + " is kept"));
  EXPECT_EQ(names_in(out_ / "range").size(), earlier);
  EXPECT_GT(names_in(fs::path(out_.string() + "-2") / "range").size(), 0U);
}

TEST_F(Interruption, KeepsTheFramesThatAreFinished) {
  for (const int signal : {SIGINT, SIGTERM}) {
    fs::remove_all(out_);
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

/// A map whose run was interrupted, of a recording that goes on for some frames more.
class InterruptedMap : public Interruption {
 protected:
  static constexpr std::size_t frames_left = 6;

  void SetUp() override {
    Interruption::SetUp();
    RunningProgram program(map_arguments(out_));
    EXPECT_TRUE(comes_true([&] { return !partial_folder().empty(); }));
    std::this_thread::sleep_for(300ms);  // some frames; none would do as well
    program.send(SIGINT);
    finished_ = program.wait();
    whole_list_ = read_text(sequence_ / "frames.txt");
    shorten_recording(read_json(out_ / "report.json")["frames"].size() + frames_left);
  }

  std::vector<std::string> map_arguments(const fs::path& out,
                                         const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"map",   sequence_.string(), "--out", out.string(),
                                       "--set", "pictures.frames=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  Finished resume(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = map_arguments(out_, more);
    arguments.push_back("--resume");
    return run_program(arguments);
  }

  Finished finished_;
  std::string whole_list_;  ///< frames.txt of the recording before it was shortened
};

TEST_F(InterruptedMap, KeepsTheMapSoFar) {
  EXPECT_EQ(finished_.status, 130) << finished_.err;
  EXPECT_THAT(finished_.out, HasSubstr("--resume"));
  EXPECT_EQ(read_json(out_ / "report.json")["summary"]["interrupted"], true);
  EXPECT_TRUE(fs::exists(out_ / "map.ply"));
}

TEST_F(InterruptedMap, SaysSoOnItsPage) {
  EXPECT_THAT(read_text(out_ / "report.html"),
              AllOf(HasSubstr("The run was interrupted."), Not(HasSubstr("Looks right.")),
                    Not(HasSubstr("The truth is not known"))));
}

TEST_F(Interruption, OfAnEvaluationNamesTheMethodsThatAreMissing) {
  shorten_recording(60);  // a second or so a method
  RunningProgram program({"evaluate", sequence_.string(), "--out", out_.string(), "--set",
                          "evaluation.methods=none jump joint", "--set", "pictures.frames=0"});
  ASSERT_TRUE(comes_true([&] {
    return program.has_ended() || fs::exists(partial_folder() / "none" / "trajectory.txt");
  }));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  EXPECT_EQ(read_json(out_ / "report.json")["interrupted"], true);
  EXPECT_THAT(
      read_text(out_ / "report.html"),
      AllOf(HasSubstr("these methods are missing: jump, joint"), Not(HasSubstr("Looks right."))));
}

TEST_F(Interruption, OfDrawingLeavesTheMapWhole) {
  constexpr std::size_t few = 30;  // soon mapped, and drawn in some seconds
  shorten_recording(few);
  RunningProgram program({"map", sequence_.string(), "--out", out_.string(), "--set",
                          "pictures.frames=" + std::to_string(few)});
  ASSERT_TRUE(comes_true([&] { return program.has_ended() || fs::exists(out_ / "map.ply"); }));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("but without pictures or report.html"));
  EXPECT_EQ(read_json(out_ / "report.json")["summary"]["interrupted"], false);
  EXPECT_EQ(read_json(out_ / "report.json")["frames"].size(), few);
  EXPECT_FALSE(fs::exists(out_ / "report.html"));
  EXPECT_THAT(names_in(out_), Not(Contains(HasSubstr("partial"))));
}

TEST_F(Interruption, OfDrawingLeavesUnwrappedRangesWhole) {
  constexpr std::size_t few = 30;
  shorten_recording(few);
  RunningProgram program({"unwrap", sequence_.string(), "--out", out_.string(), "--set",
                          "pictures.frames=" + std::to_string(few)});
  ASSERT_TRUE(comes_true([&] { return program.has_ended() || fs::exists(out_ / "report.json"); }));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  EXPECT_EQ(names_in(out_ / "range").size(), few);
  EXPECT_THAT(names_in(out_), Not(Contains(HasSubstr("pictures"))));
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"out", "seq"}));
}

TEST_F(Interruption, OfAnEvaluationsPicturesLeavesItsMapsWhole) {
  constexpr std::size_t few = 30;
  shorten_recording(few);
  RunningProgram program({"evaluate", sequence_.string(), "--out", out_.string(), "--set",
                          "evaluation.methods=none pixel", "--set",
                          "pictures.frames=" + std::to_string(few)});
  ASSERT_TRUE(comes_true([&] { return program.has_ended() || fs::exists(out_ / "report.json"); }));
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 130) << finished.err;
  EXPECT_EQ(read_json(out_ / "report.json")["interrupted"], false);
  EXPECT_TRUE(fs::exists(out_ / "none" / "map.ply") && fs::exists(out_ / "pixel" / "map.ply"));
  EXPECT_FALSE(fs::exists(out_ / "report.html"));
}

TEST_F(Interruption, ByKillWhileDrawingHindersNoOtherRun) {
  constexpr std::size_t few = 30;
  shorten_recording(few);
  const std::vector<std::string> drawing{"unwrap", sequence_.string(),
                                         "--out",  out_.string(),
                                         "--set",  "pictures.frames=" + std::to_string(few)};
  RunningProgram program(drawing);
  ASSERT_TRUE(comes_true([&] {
    if (program.has_ended()) return true;
    return testing::Matches(Contains(HasSubstr("pictures.partial-")))(names_in(folder_.path()));
  }));
  program.send(SIGKILL);
  program.wait();
  ASSERT_THAT(names_in(folder_.path()), Contains(HasSubstr("pictures.partial-")));
  EXPECT_EQ(run("unwrap").status, 0);
  EXPECT_THAT(names_in(out_), Not(Contains(HasSubstr("partial"))));
}

TEST_F(InterruptedMap, GoesOnToTheSameResult) {
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  const fs::path at_once = folder_.path() / "at_once";
  ASSERT_EQ(run_program(map_arguments(at_once)).status, 0);
  for (const std::string name : {"map.ply", "mesh.ply", "trajectory.txt", "keyframes.txt"}) {
    EXPECT_TRUE(read_text(out_ / name) == read_text(at_once / name)) << name;
  }
  EXPECT_EQ(read_json(out_ / "report.json")["frames"].size(),
            read_json(at_once / "report.json")["frames"].size());
}

TEST_F(InterruptedMap, DoesNotGoOnWithOtherOptions) {
  const Finished resumed = resume({"--set", "map.voxel_m=0.05"});
  EXPECT_EQ(resumed.status, 2);
  EXPECT_THAT(resumed.err, HasSubstr("voxel_m: 0.05"));
  EXPECT_TRUE(fs::exists(out_ / "map.db")) << "what there was is lost";
}

TEST_F(InterruptedMap, DoesNotGoOnWithAnotherLargestRange) {
  std::ofstream(sequence_ / "sequence.yaml", std::ios::app) << "max_range_m: 9\n";
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 2);
  EXPECT_THAT(resumed.err, HasSubstr("largest range: 9 m"));
}

TEST_F(InterruptedMap, IsKeptWithoutItsStateIfTheDiskIsFull) {
  if (TOFMAP_COVERAGE) GTEST_SKIP() << "coverage is written to files, too";
  const std::size_t state = fs::file_size(out_ / "map.db");
  const std::size_t map = fs::file_size(out_ / "map.ply");
  ASSERT_LT(map, state / 2);
  fs::remove_all(out_);
  std::ofstream(sequence_ / "frames.txt") << whole_list_;
  RunningProgram program(map_arguments(out_), {.max_file_bytes = state / 2});
  EXPECT_TRUE(comes_true([&] { return !partial_folder().empty(); }));
  std::this_thread::sleep_for(300ms);
  program.send(SIGINT);
  const Finished finished = program.wait();
  EXPECT_EQ(finished.status, 3);
  EXPECT_THAT(finished.err, HasSubstr("holds the map, but without map.db: "));
  EXPECT_THAT(finished.out, Not(HasSubstr("--resume")));
  EXPECT_TRUE(fs::exists(out_ / "map.ply"));
  EXPECT_FALSE(fs::exists(out_ / "map.db"));
}

TEST_F(InterruptedMap, DoesNotGoOnWithAMapThatItDoesNotExtend) {
  const fs::path other = fs::path(TOFMAP_SOURCE_DIR) / "tests/mapping/maps/version_1.db";
  const Finished resumed = resume({"--onto", other});
  EXPECT_EQ(resumed.status, 3);
  EXPECT_THAT(resumed.err, HasSubstr("does not extend " + other.string()));
}

TEST_F(InterruptedMap, DoesNotGoOnWithAnotherRecording) {
  shorten_recording(1);
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 3);
  EXPECT_THAT(resumed.err, HasSubstr("another recording"));
}

TEST_F(InterruptedMap, DoesNotGoOnWithARecordingOfTheSameTimes) {
  if (read_json(out_ / "report.json")["frames"].empty()) GTEST_SKIP() << "nothing was mapped";
  fs::copy_file(sequence_ / "phase_b" / "000000.png", sequence_ / "phase_a" / "000000.png",
                fs::copy_options::overwrite_existing);
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 3);
  EXPECT_THAT(resumed.err, HasSubstr("another recording"));
}

TEST_F(InterruptedMap, DoesNotGoOnFromADamagedState) {
  const std::string state = read_text(out_ / "map.db");
  for (const std::size_t size : {std::size_t{10}, state.size() / 2, state.size() - 1}) {
    std::ofstream(out_ / "map.db", std::ios::binary) << state.substr(0, size);
    const Finished resumed = resume();
    EXPECT_EQ(resumed.status, 3) << size;
    EXPECT_THAT(resumed.err, HasSubstr("map.db, which was changed since tofmap wrote it"));
  }
  for (const std::size_t at : {std::size_t{3}, std::size_t{400}, state.size() / 2}) {
    std::string flipped = state;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    std::ofstream(out_ / "map.db", std::ios::binary) << flipped;
    const Finished resumed = resume();
    EXPECT_EQ(resumed.status, 3) << at;
    EXPECT_THAT(resumed.err, HasSubstr("map.db, which was changed since tofmap wrote it")) << at;
  }
}

TEST_F(InterruptedMap, ThatIsFinishedOrNotBegunIsNoneToGoOnWith) {
  ASSERT_EQ(resume().status, 0);
  EXPECT_EQ(resume().status, 3) << "there is nothing left to do";
  fs::remove_all(out_);
  EXPECT_EQ(resume().status, 0) << "the first run of a script that always says --resume";
}

TEST_F(InterruptedMap, BeginsAnewWhereAKilledRunHasLeftNothingToGoOnWith) {
  fs::remove_all(out_);
  // A map without a run, as of a process that was killed just before or after it stored one.
  const fs::path left = out_.string() + ".partial-1";
  fs::create_directory(left);
  fs::copy_file(fs::path(TOFMAP_SOURCE_DIR) / "tests/mapping/maps/version_1.db", left / "map.db");
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(InterruptedMap, IsResumedBesideFoldersThatAreNotItsOwn) {
  const fs::path damaged = out_.string() + ".partial-1";
  fs::create_directory(damaged);
  std::ofstream(damaged / "map.db") << "no map";
  // A result that could not be moved into place.
  const fs::path result = out_.string() + ".partial-2";
  fs::create_directory(result);
  fs::copy_file(fs::path(TOFMAP_SOURCE_DIR) / "tests/mapping/maps/version_1.db", result / "map.db");
  std::ofstream(result / "trajectory.txt") << "# timestamp tx ty tz qx qy qz qw\n";
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr((damaged / "map.db").string()));
  EXPECT_TRUE(fs::exists(damaged));
  EXPECT_TRUE(fs::exists(result));
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

TEST_F(InterruptedMap, GoesOnToTheSameResultAfterItWasKilled) {
  fs::remove_all(out_);
  std::ofstream(sequence_ / "frames.txt") << whole_list_;
  shorten_recording(60);
  const auto is_stored = [&] {
    // The file has its tables, and the first frames beside it.
    std::error_code error;
    return fs::file_size(partial_folder() / "map.db-wal", error) > 1'000'000 && !error;
  };
  int kills = 0;
  for (const std::string option : {"--quiet", "--resume"}) {
    RunningProgram program(map_arguments(out_, {option}));
    ASSERT_TRUE(comes_true([&] { return program.has_ended() || is_stored(); }));
    if (program.has_ended()) break;
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().status, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(out_)) << "a half result looks whole";
    ++kills;
  }
  ASSERT_GT(kills, 0);
  const Finished resumed = resume();
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_TRUE(partial_folder().empty());
  const fs::path at_once = folder_.path() / "at_once";
  ASSERT_EQ(run_program(map_arguments(at_once)).status, 0);
  for (const std::string name : {"map.ply", "mesh.ply", "trajectory.txt", "keyframes.txt"}) {
    EXPECT_TRUE(read_text(out_ / name) == read_text(at_once / name)) << name;
  }
}

}  // namespace
}  // namespace tofmap::test
