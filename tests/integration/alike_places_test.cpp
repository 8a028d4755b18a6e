// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// A camera is localised in a hall that looks the same from both ends.

#include "program.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {
namespace {

/// Two recordings of the hall, between which furniture was moved.
class AlikePlaces : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return folder_.path() / name; }

  void run(std::vector<std::string> arguments, const std::string& out) const {
    arguments.insert(arguments.end(), {"--out", at(out)});
    const test::Finished finished = test::run_program(arguments);
    ASSERT_EQ(finished.status, 0) << finished.err;
  }

  void simulate(const std::string& seed, const std::string& out,
                const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{"simulate", "hall", "--seed", seed, "--frames", "150"};
    arguments.insert(arguments.end(), {"--set", "simulator.width_px=88", "simulator.height_px=72",
                                       "simulator.subpixels=1"});
    arguments.insert(arguments.end(), options.begin(), options.end());
    run(arguments, out);
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(AlikePlaces, AreToldApartByLaterFrames) {
  // At first, what was moved contradicts the right place more than that at the other end.
  simulate("13", "first", {});
  simulate("13", "second",
           {"simulator.rearranged=6", "simulator.arrangement=13", "simulator.walk=13"});
  run({"map", at("first")}, "map");
  run({"localise", at("second"), "--in", at("map")}, "found");
  const Trajectory truth = read_trajectory(at("second/groundtruth.txt"));
  const Trajectory found = read_trajectory(at("found/trajectory.txt"));
  ASSERT_EQ(found.size(), 150U);
  // The first frame of the first recording is the origin of the map.
  const Pose map_from_world =
      read_trajectory(at("first/groundtruth.txt")).front().world_from_camera.inverse();
  for (const auto& [timestamp_s, pose] : found) {
    const auto there = pose_at(truth, timestamp_s);
    ASSERT_TRUE(there);
    EXPECT_LT((pose.translation() - (map_from_world * *there).translation()).norm(), 0.1);
  }
}

}  // namespace
}  // namespace tofmap
