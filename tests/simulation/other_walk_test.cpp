// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/rearrangement.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

SimulatorOptions walk_options(int walk) {
  SimulatorOptions options;
  options.width_px = 16;
  options.height_px = 12;
  options.subpixels = 1;
  options.walk = walk;
  return options;
}

/// How far the poses of a walk are from the nearest poses of another one, on average.
struct Deviation {
  double distance_m = 0;
  double angle_deg = 0;
};

Deviation deviation(const Trajectory& walk, const Trajectory& from) {
  Deviation mean;
  for (const StampedPose& pose : walk) {
    const auto distance_m = [&](const StampedPose& other) {
      return (other.world_from_camera.translation() - pose.world_from_camera.translation()).norm();
    };
    const StampedPose& nearest = *std::ranges::min_element(from, {}, distance_m);
    mean.distance_m += distance_m(nearest) / static_cast<double>(walk.size());
    mean.angle_deg += rotation_angle_rad(nearest.world_from_camera, pose.world_from_camera) * 180 /
                      std::numbers::pi / static_cast<double>(walk.size());
  }
  return mean;
}

class OtherWalk : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Each, OtherWalk, testing::ValuesIn(scene_names()),
                         [](const auto& instance) { return instance.param; });

TEST_P(OtherWalk, DeviatesFromThePathOfTheSceneByDecimetresAndDegrees) {
  const Simulator usual(make_scene(GetParam()), walk_options(0));
  // The gaps of this scene leave little space.
  const double least_m = GetParam() == "passage" ? 0.12 : 0.25;
  for (const int walk : {1, 2, 3}) {
    const Simulator other(make_scene(GetParam()), walk_options(walk));
    const Deviation mean = deviation(other.trajectory(), usual.trajectory());
    EXPECT_GT(mean.distance_m, least_m) << "walk " << walk;
    EXPECT_LT(mean.distance_m, 1.5) << "walk " << walk;
    EXPECT_GT(mean.angle_deg, 4) << "walk " << walk;
    EXPECT_LT(mean.angle_deg, 60) << "walk " << walk;
  }
}

TEST_P(OtherWalk, StaysWithinTheLimitsAndClearOfRearrangedFurniture) {
  for (const int walk : {1, 2, 3}) {
    SimulatorOptions options = walk_options(walk);
    options.rearranged = 9;
    options.arrangement = walk;
    const Simulator simulator(make_scene(GetParam()), options);
    const Trajectory& poses = simulator.trajectory();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Vector3d place_m = poses[i].world_from_camera.translation();
      EXPECT_GE(simulator.rays().clearance_m(place_m, 1), 0.3) << "frame " << i;
      for (const FurniturePiece& piece : simulator.furniture()) {
        EXPECT_FALSE(piece.box.contains(place_m)) << piece.name << ", frame " << i;
      }
      if (i == 0) continue;
      const Vector3d step = place_m - poses[i - 1].world_from_camera.translation();
      EXPECT_LE(step.norm(), 0.07) << "frame " << i;
      EXPECT_LE(rotation_angle_rad(poses[i - 1].world_from_camera, poses[i].world_from_camera),
                3 * std::numbers::pi / 180)
          << "frame " << i;
    }
  }
}

TEST_P(OtherWalk, SeesSurfacesInAllDirections) {
  if (GetParam() == "slope") GTEST_SKIP() << "is open beside its wall";
  for (const int walk : {1, 2, 3}) {
    const Simulator simulator(make_scene(GetParam()), walk_options(walk));
    const int last = *simulator.frame_count() - 1;
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(simulator.simulate(last * i / 4).range_truth_m.isNaN().any())
          << "walk " << walk << ", place " << i;
    }
  }
}

TEST_P(OtherWalk, DependsOnItsSeedAlone) {
  SimulatorOptions options = walk_options(4);
  const Simulator one(make_scene(GetParam()), options);
  const Simulator other(make_scene(GetParam()), walk_options(5));
  options.range_noise_m = 0.05;
  options.errors_seed = 9;
  options.frames = *one.frame_count();
  const Simulator again(make_scene(GetParam()), options);
  EXPECT_NE(one.trajectory()[1].world_from_camera.matrix(),
            other.trajectory()[1].world_from_camera.matrix());
  for (std::size_t i = 0; i < one.trajectory().size(); ++i) {
    ASSERT_EQ(one.trajectory()[i].world_from_camera.matrix(),
              again.trajectory()[i].world_from_camera.matrix());
  }
}

TEST_P(OtherWalk, OfSeed0IsThePathOfTheScene) {
  const Scene scene = make_scene(GetParam());
  const CameraPath walk = other_walk(scene, 0);
  for (double u = 0; u <= walk.end(); u += 0.31) {
    EXPECT_EQ(walk.pose_at(u).matrix(), scene.path.pose_at(u).matrix());
  }
}

TEST(OtherWalkOfAMesh, DeviatesAndStaysClearOfSurfaces) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "hall.ply";
  write_mesh_ply(file, make_scene("hall").surface);
  const Simulator usual(find_scene(file.string()), walk_options(0));
  const Simulator other(find_scene(file.string()), walk_options(1));
  const Deviation mean = deviation(other.trajectory(), usual.trajectory());
  EXPECT_GT(mean.distance_m, 0.15);
  EXPECT_GT(mean.angle_deg, 4);
  for (const StampedPose& pose : other.trajectory()) {
    EXPECT_GE(other.rays().clearance_m(pose.world_from_camera.translation(), 1), 0.3);
  }
}

TEST(OtherWalkOptions, RefuseAWalkWithPosesFromAFile) {
  const test::TemporaryFolder folder;
  SimulatorOptions options = walk_options(2);
  options.trajectory_file = (folder.path() / "poses.txt").string();
  write_trajectory(options.trajectory_file, {{0, look_along({0.9, 2.2, 1.5}, {1, 0, 0})}});
  EXPECT_THROW(Simulator(make_scene("wall"), options), UsageError);
  options.walk = 0;
  EXPECT_NO_THROW(Simulator(make_scene("wall"), options));
}

}  // namespace
}  // namespace tofmap
