// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Finished maps are used again: localise, map --onto, merge, info and view.

#include "program.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

/// Recordings and maps by their names, which are made when a case first needs them: "first" and
/// "second" of one room, between which much was rearranged, and "elsewhere"; "map_first" and
/// "map_second"; the first map with the second recording, "extended". Cases must leave these as
/// they are.
class ReusedMap : public testing::Test {
 protected:
  static constexpr std::size_t frames = 36;

  static std::string at(const std::string& name) {
    static const test::TemporaryFolder folder;
    return folder.path() / name;
  }

  std::string made(const std::string& name) const {
    if (fs::exists(at(name))) return at(name);
    if (name == "first") {
      simulate("room", name, {});
    } else if (name == "second") {
      simulate("room", name, {"simulator.rearranged=12"});
    } else if (name == "elsewhere") {
      simulate("flat", name, {});
    } else if (name == "extended") {
      expect_success(run({"map", made("second"), "--onto", made("map_first")}, name));
    } else {
      expect_success(run({"map", made(name.substr(4)), "--set", "map.voxel_m=0.2"}, name));
    }
    return at(name);
  }

  /// The address of a device that plays a recording. Frames are made when they are asked for.
  std::string device_of(const std::string& recording) const {
    return "tofmap://" + made(recording) + "?speed=-1";
  }

  void simulate(const std::string& scene, const std::string& name,
                const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{"simulate",
                                       scene,
                                       "--frames",
                                       std::to_string(frames),
                                       "--set",
                                       "simulator.width_px=64",
                                       "simulator.height_px=52",
                                       "simulator.subpixels=1"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_success(run(arguments, name));
  }

  test::Finished run(std::vector<std::string> arguments, const std::string& out) const {
    arguments.insert(arguments.end(), {"--out", at(out)});
    return test::run_program(arguments);
  }

  static void expect_success(const test::Finished& finished) {
    EXPECT_EQ(finished.status, 0) << finished.err;
  }

  /// The rows that the sqlite3 shell prints for a query of a map.
  std::string query(const std::string& map, const std::string& sql) const {
    const std::string file = at(map) + "/map.db";
    const std::string command = "sqlite3 -readonly '" + file + "' \"" + sql + "\" 2>&1";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::string rows;
    for (std::array<char, 256> part; fgets(part.data(), part.size(), pipe.get()) != nullptr;) {
      rows += part.data();
    }
    return rows;
  }
};

TEST_F(ReusedMap, TellsWhereACameraIs) {
  const test::Finished found =
      run({"localise", made("second"), "--in", made("map_first")}, "found");
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("36 of 36 frames localised"));
  EXPECT_EQ(read_trajectory(at("found/trajectory.txt")).size(), frames);
  const auto report = test::read_json(at("found/report.json"));
  ASSERT_EQ(report["frames"].size(), frames);
  for (const auto& frame : report["frames"]) {
    EXPECT_EQ(frame["status"], "localised");
    EXPECT_EQ(frame["covariance"].size(), 36U);
    EXPECT_GT(frame["covariance"][35], 0);
  }
}

TEST_F(ReusedMap, TellsAProgramWhereADeviceIs) {
  const test::Finished found =
      run({"localise", device_of("second"), "--in", made("map_first"), "--poses"}, "found");
  ASSERT_EQ(found.status, 0) << found.err;
  const std::string printed = at("printed.txt");
  std::ofstream(printed) << found.out;
  // Less is known while the camera moves than at the end.
  const Trajectory live = read_trajectory(printed);
  const Trajectory final = read_trajectory(at("found/trajectory.txt"));
  EXPECT_EQ(live.size(), frames);
  ASSERT_EQ(live.size(), final.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    EXPECT_EQ(live[i].timestamp_s, final[i].timestamp_s);
    EXPECT_LT(twist_between(live[i].world_from_camera, final[i].world_from_camera).norm(), 0.05);
  }
}

TEST_F(ReusedMap, IsExtendedByADevice) {
  expect_success(run({"map", device_of("second"), "--onto", made("map_first")}, "live"));
  EXPECT_EQ(query("live", "SELECT COUNT(*) FROM recordings"), "2\n");
  EXPECT_EQ(read_trajectory(at("live/trajectory.txt")).size(), frames);
}

TEST_F(ReusedMap, IsExtendedByAnotherRecording) {
  made("extended");
  EXPECT_THAT(test::names_in(made("extended")),
              IsSupersetOf({"map.db", "map.ply", "trajectory.txt", "report.html", "changes.ply"}));
  const auto report = test::read_json(at("extended/report.json"));
  EXPECT_EQ(report["judgement"]["verdict"], "good");
  ASSERT_FALSE(report["changes"].empty());
  const std::string page = test::read_text(at("extended/report.html"));
  EXPECT_THAT(page, HasSubstr("What has changed"));
  EXPECT_EQ(query("map_first", "SELECT COUNT(*) FROM recordings"), "1\n");
  EXPECT_EQ(query("extended", "SELECT COUNT(*) FROM recordings"), "2\n");
}

TEST_F(ReusedMap, IsExtendedWithoutAWordOfLostTracking) {
  const std::string report = test::read_text(made("extended") + "/report.json");
  EXPECT_THAT(report, Not(HasSubstr("when tracking was lost")));
}

TEST_F(ReusedMap, IsExtendedByARunThatSaysResumeWhereThereIsNothingToResume) {
  expect_success(run({"map", made("second"), "--onto", made("map_first"), "--resume"}, "resumed"));
  EXPECT_EQ(test::read_text(at("resumed/trajectory.txt")),
            test::read_text(made("extended") + "/trajectory.txt"));
}

TEST_F(ReusedMap, IsNotReplacedByAResultThatIsNoMapOfIt) {
  const std::string map = test::read_text(made("map_first") + "/map.db");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"localise", made("second"), "--in", at("map_first")},
                                             {"merge", made("map_second"), at("map_first")}}) {
    const test::Finished refused = run(arguments, "map_first");
    EXPECT_EQ(refused.status, 2) << arguments[0];
    EXPECT_THAT(refused.err, HasSubstr("give another --out")) << arguments[0];
    EXPECT_TRUE(test::read_text(at("map_first/map.db")) == map) << arguments[0];
  }
}

TEST_F(ReusedMap, IsNotReplacedByAMapOfOneRecordingOnceItHasSeveral) {
  made("extended");
  const test::Finished refused = run({"map", made("second")}, "extended");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("is a map of 2 recordings"));
  EXPECT_EQ(query("extended", "SELECT COUNT(*) FROM recordings"), "2\n");
}

TEST_F(ReusedMap, IsNotExtendedByARecordingThatItHas) {
  const test::Finished refused = run({"map", made("first"), "--onto", made("map_first")}, "twice");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("would count twice"));
}

TEST_F(ReusedMap, IsMergedWithAnotherOneInAnyOrder) {
  for (const auto& [one, other] :
       {std::pair("map_first", "map_second"), std::pair("map_second", "map_first")}) {
    const std::string out = std::string("merged_") + one;
    const test::Finished merged = run({"merge", made(one), made(other)}, out);
    ASSERT_EQ(merged.status, 0) << merged.err;
    EXPECT_THAT(merged.out, HasSubstr("2 of 2 maps merged"));
    EXPECT_THAT(test::names_in(at(out)),
                IsSupersetOf({"map.db", "map.ply", "trajectory_1.txt", "trajectory_2.txt"}));
    EXPECT_EQ(query(out, "SELECT source FROM recordings ORDER BY id"),
              made("first") + "\n" + made("second") + "\n");
  }
}

TEST_F(ReusedMap, IsNotThatOfAnotherPlace) {
  for (const auto& [command, option] :
       {std::pair("localise", "--in"), std::pair("map", "--onto")}) {
    const test::Finished refused =
        run({command, made("elsewhere"), option, made("map_first")}, "refused");
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, AllOf(HasSubstr("none of 36 frames could be found in the map"),
                                   HasSubstr("keyframes that were compared")));
    EXPECT_FALSE(fs::exists(at("refused")));
  }
}

TEST_F(ReusedMap, MayBeToldWhereTheCameraBegins) {
  const auto localise = [&](const std::string& start, const std::string& out) {
    return run({"localise", made("second"), "--in", made("map_first"), "--start", start}, out);
  };
  expect_success(localise("0", "started_at_keyframe"));
  expect_success(localise("0.1,0,0.1", "started_at_position"));
  EXPECT_EQ(localise("20,0,20", "started_elsewhere").status, 3);
  EXPECT_EQ(localise("0,0,0,0,1,0,0", "started_backwards").status, 3);
  const test::Finished of_no_map = run({"map", made("second"), "--start", "0"}, "started_anew");
  EXPECT_EQ(of_no_map.status, 2);
  EXPECT_THAT(of_no_map.err, HasSubstr("--onto"));
  const test::Finished unknown = localise("1000", "started_nowhere");
  EXPECT_NE(unknown.status, 0);
  EXPECT_THAT(unknown.err, HasSubstr("1000"));
}

TEST_F(ReusedMap, IsToldWhatIsInIt) {
  const test::Finished told = test::run_program({"info", made("extended")});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(HasSubstr("recording 0: " + made("first")),
                              HasSubstr("recording 1: " + made("second")), HasSubstr("36 frames"),
                              HasSubstr("new, noticed ")));
}

TEST_F(ReusedMap, ShowsItsKeyframes) {
  const std::string picture = at("keyframe.png");
  const test::Finished shown =
      test::run_program({"view", made("extended"), "--keyframe", "3", "--screenshot", picture});
  ASSERT_EQ(shown.status, 0) << shown.err;
  EXPECT_GT(fs::file_size(picture), 1000U);
}

TEST_F(ReusedMap, AnswersTheQueriesOfItsDocumentation) {
  made("extended");
  if (query("extended", "SELECT 1") != "1\n") GTEST_SKIP() << "the sqlite3 shell is missing";
  const std::string text = test::read_text(fs::path(TOFMAP_SOURCE_DIR) / "docs/map-format.md");
  const std::regex block("```sql\n([^`]*)```");
  int queries = 0;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), block);
       match != std::sregex_iterator(); ++match) {
    const std::string rows = query("extended", (*match)[1]);
    EXPECT_THAT(rows, AllOf(HasSubstr("|"), Not(HasSubstr("rror")))) << (*match)[1];
    ++queries;
  }
  EXPECT_EQ(queries, 3);
}

TEST_F(ReusedMap, IsRefusedIfItIsDamaged) {
  fs::create_directory(at("damaged"));
  std::ofstream(at("damaged/map.db"))
      << test::read_text(made("extended") + "/map.db").substr(0, 200000);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"localise", made("second"), "--in", at("damaged"), "--out", at("of_damaged")},
           {"map", made("second"), "--onto", at("damaged"), "--out", at("of_damaged")},
           {"merge", made("map_second"), at("damaged"), "--out", at("of_damaged")},
           {"info", at("damaged")}}) {
    const test::Finished refused = test::run_program(arguments);
    EXPECT_EQ(refused.status, 3) << arguments[0];
    EXPECT_THAT(refused.err, HasSubstr("damaged/map.db")) << arguments[0];
    EXPECT_FALSE(fs::exists(at("of_damaged")));
  }
}

/// A map that an earlier version wrote (tests/mapping/maps).
TEST_F(ReusedMap, MayBeOfAnEarlierVersion) {
  for (const auto& kept :
       fs::directory_iterator(fs::path(TOFMAP_SOURCE_DIR) / "tests/mapping/maps")) {
    if (kept.path().extension() != ".db") continue;
    const std::string out = kept.path().stem();
    const test::Finished found = run({"localise", made("first"), "--in", kept.path()}, out);
    ASSERT_EQ(found.status, 0) << kept.path() << ": " << found.err;
    EXPECT_THAT(found.out, HasSubstr("36 of 36 frames localised"));
  }
}

}  // namespace
}  // namespace tofmap
