// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "program.hpp"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;

/// A recording of a flat whose camera is carried, unseen, from one room into another.
class CarriedCamera : public testing::Test {
 protected:
  static constexpr int frames_before = 30;
  static constexpr int frames_after = 20;

  void SetUp() override {
    const std::vector<std::string> small{"--set", "simulator.width_px=88",
                                         "simulator.height_px=72"};
    const auto simulate = [&](const std::string& folder, const std::vector<std::string>& more) {
      std::vector<std::string> arguments{"simulate", "flat", "--out", folder};
      arguments.insert(arguments.end(), small.begin(), small.end());
      arguments.insert(arguments.end(), more.begin(), more.end());
      ASSERT_EQ(test::run_program(arguments).status, 0);
    };
    const std::string path = folder_.path() / "path";
    simulate(path, {"simulator.subpixels=1"});
    const Trajectory whole = read_trajectory(path + "/groundtruth.txt");
    Trajectory carried(whole.begin(), whole.begin() + frames_before);
    carried.insert(carried.end(), whole.begin() + 160, whole.begin() + 160 + frames_after);
    for (std::size_t i = 0; i < carried.size(); ++i) {
      carried[i].timestamp_s = static_cast<double>(i) / 15;
    }
    const std::string file = folder_.path() / "carried.txt";
    write_trajectory(file, carried);
    simulate(sequence_, {"simulator.trajectory_file=" + file});
  }

  test::TemporaryFolder folder_;
  const std::string sequence_ = folder_.path() / "recording";
  const std::filesystem::path out_ = folder_.path() / "map";
};

TEST_F(CarriedCamera, GetsAMapOfEachRoomAndIsToBeChecked) {
  const test::Finished run = test::run_program({"map", sequence_, "--out", out_});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(test::names_in(out_), IsSupersetOf({"map.ply", "map_2.ply", "trajectory.txt",
                                                  "trajectory_2.txt", "keyframes_2.txt"}));
  // B of the last frame before was taken on the way to the other room.
  EXPECT_EQ(read_trajectory(out_ / "trajectory.txt").size(), frames_before - 1U);
  EXPECT_EQ(read_trajectory(out_ / "trajectory_2.txt").size(), std::size_t{frames_after});
  EXPECT_THAT(run.out, HasSubstr("map_2.ply: 20 frames (frames 30 to 49, 2.00 to 3.27 s after the "
                                 "first frame), begun after 1 frame that is in no map"));
  EXPECT_THAT(run.out, HasSubstr("1 frame in no map, not registered: 29"));
  EXPECT_THAT(run.out, HasSubstr("tofmap register " + (out_ / "map.ply").string()));
  const auto report = test::read_json(out_ / "report.json");
  const auto& separate = report["summary"]["separate_maps"];
  ASSERT_EQ(separate.size(), 1U);
  EXPECT_EQ(separate[0]["map"], "map_2.ply");
  EXPECT_EQ(separate[0]["registered"], frames_after);
  EXPECT_GT(separate[0]["map_points"], 1000);
  EXPECT_EQ(separate[0]["first_frame"], frames_before);
  EXPECT_EQ(separate[0]["last_frame"], frames_before + frames_after - 1);
  EXPECT_EQ(report["frames"][0]["map"], 1);
  EXPECT_EQ(report["frames"][frames_before - 1]["map"], nullptr);
  EXPECT_EQ(report["frames"][frames_before]["map"], 2);
  EXPECT_EQ(report["summary"]["missing"]["unregistered"], 1);
  EXPECT_EQ(report["frames"][frames_before]["tracking"]["status"], "first");
  EXPECT_EQ(report["frames"][frames_before + 1]["tracking"]["status"], "tracked");
  EXPECT_EQ(report["judgement"]["verdict"], "check");
  const std::string reason = "1 other map with 20 frames could not be joined with this one";
  EXPECT_THAT(report["judgement"]["reasons"][0].get<std::string>(), HasSubstr(reason));
  EXPECT_THAT(run.out, HasSubstr("verdict: Check this result. Reasons: tracking was lost"));
  const std::string page = test::read_text(out_ / "report.html");
  EXPECT_THAT(page, HasSubstr(reason));
  EXPECT_THAT(page, HasSubstr("<td>frames 30 to 49, 2.00 to 3.27 s after the first frame</td>"));
  EXPECT_THAT(page, HasSubstr("map_2.ply, coloured by height"));
  EXPECT_THAT(page, HasSubstr("Frames in no map"));
}

}  // namespace
}  // namespace tofmap
