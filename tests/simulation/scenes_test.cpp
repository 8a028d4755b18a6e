// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

constexpr double wavelength_a_m = speed_of_light_m_per_s / (2 * 29e6);

SimulatorOptions options_of(int subpixels) {
  SimulatorOptions options;
  options.subpixels = subpixels;
  options.range_noise_m = 0;
  return options;
}

/// Truth of a few frames along the path, the first and the last among them.
std::vector<ImageF> sampled_truth(const Simulator& simulator, int count) {
  std::vector<ImageF> truth;
  const int last = *simulator.frame_count() - 1;
  for (int i = 0; i < count; ++i) {
    truth.push_back(simulator.simulate(last * i / (count - 1)).range_truth_m);
  }
  return truth;
}

/// NaN in no comparison: pixels without a surface count neither as near nor as far.
double smallest(const ImageF& range_m) { return range_m.isNaN().select(1e9F, range_m).minCoeff(); }
double largest(const ImageF& range_m) { return range_m.isNaN().select(0.0F, range_m).maxCoeff(); }

double largest_step_between_neighbours(const ImageF& range_m) {
  const Eigen::Index rows = range_m.rows();
  const Eigen::Index cols = range_m.cols();
  const ImageF across = (range_m.rightCols(cols - 1) - range_m.leftCols(cols - 1)).abs();
  const ImageF down = (range_m.bottomRows(rows - 1) - range_m.topRows(rows - 1)).abs();
  return std::max(largest(across), largest(down));
}

class BuiltInScene : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Each, BuiltInScene, testing::ValuesIn(scene_names()),
                         [](const auto& instance) { return instance.param; });

TEST_P(BuiltInScene, IsWalkedThroughWithinTheLimitsAndClearOfSurfaces) {
  const Simulator simulator(make_scene(GetParam()), options_of(1));
  const Trajectory& poses = simulator.trajectory();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i].world_from_camera;
    EXPECT_GE(simulator.rays().clearance_m(pose.translation(), 1), 0.3) << "frame " << i;
    if (i == 0) continue;
    const Pose& last = poses[i - 1].world_from_camera;
    const Eigen::Vector3d step = pose.translation() - last.translation();
    EXPECT_LE(step.norm(), 0.07) << "frame " << i;
    EXPECT_LE(rotation_angle_rad(last, pose), 3 * std::numbers::pi / 180) << "frame " << i;
    if (step.norm() > 0) {
      EXPECT_FALSE(simulator.rays().cast(last.translation(), step.normalized(), step.norm()))
          << "through a surface before frame " << i;
    }
  }
}

TEST_P(BuiltInScene, KnowsItsNameAndReach) {
  const Scene scene = make_scene(GetParam());
  EXPECT_EQ(scene.name, GetParam());
  SimulatorOptions options = options_of(1);
  options.max_range_m = 65;
  const Simulator simulator(scene, options);
  for (const ImageF& range_m : sampled_truth(simulator, 7)) {
    EXPECT_FALSE(range_m.isNaN().any()) << "a gap in the walls";
    EXPECT_LT(largest(range_m), scene.max_range_m);
  }
}

TEST_P(BuiltInScene, HasSurfacesOfVariedButPlausibleReflectance) {
  const Scene scene = make_scene(GetParam());
  const auto [darkest, brightest] = std::ranges::minmax(scene.surface.reflectance);
  EXPECT_GE(darkest, 0.05F);
  EXPECT_LE(brightest, 0.95F);
  EXPECT_GT(brightest - darkest, 0.05F);
}

TEST(WallScene, IsContinuousAndReachesBeyondOneWavelength) {
  const Simulator simulator(make_scene("wall"), options_of(1));
  for (const ImageF& range_m : sampled_truth(simulator, 5)) {
    EXPECT_GT(largest(range_m), 1.3 * wavelength_a_m);
    EXPECT_LT(smallest(range_m), 0.8 * wavelength_a_m);
    EXPECT_LT(largest_step_between_neighbours(range_m), 0.1 * wavelength_a_m);
    EXPECT_FALSE(range_m.isNaN().any());
  }
}

TEST(SlopeScene, HoldsStepsThatLookLikeWrapsFromOneSide) {
  const Simulator simulator(make_scene("slope"), options_of(1));
  for (const ImageF& range_m : sampled_truth(simulator, 5)) {
    EXPECT_GT(largest_step_between_neighbours(range_m), wavelength_a_m / 2);
    EXPECT_LT(largest(range_m), 2 * wavelength_a_m);
  }
}

TEST(SlopeScene, HasNoWayFromNearToFarWithoutAMisleadingStep) {
  // Flood from a near corner over neighbours that differ by less than half a wavelength, and
  // see that no wrapped pixel is reached: neighbours alone cannot carry the count there.
  const Simulator simulator(make_scene("slope"), options_of(1));
  const ImageF range_m = simulator.simulate(0).range_truth_m;
  ImageU8 reached = ImageU8::Zero(range_m.rows(), range_m.cols());
  std::vector<std::pair<Eigen::Index, Eigen::Index>> open = {{0, 0}};
  reached(0, 0) = 1;
  while (!open.empty()) {
    const auto [v, u] = open.back();
    open.pop_back();
    for (const auto& [dv, du] : {std::pair{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
      const Eigen::Index row = v + dv;
      const Eigen::Index col = u + du;
      if (row < 0 || col < 0 || row >= range_m.rows() || col >= range_m.cols()) continue;
      const double step = std::abs(range_m(row, col) - range_m(v, u));
      if (reached(row, col) != 0 || !(step < wavelength_a_m / 2)) continue;
      reached(row, col) = 1;
      open.emplace_back(row, col);
    }
  }
  const auto wrapped = range_m > static_cast<float>(wavelength_a_m);
  EXPECT_GT(wrapped.count(), range_m.size() / 20);
  EXPECT_EQ((wrapped && reached != 0).count(), 0);
}

TEST(BeyondScene, LiesWhollyBeyondOneWavelength) {
  const Simulator simulator(make_scene("beyond"), options_of(1));
  for (const ImageF& range_m : sampled_truth(simulator, 5)) {
    EXPECT_GT(smallest(range_m), wavelength_a_m);
    EXPECT_FALSE(range_m.isNaN().any());
  }
}

TEST(CorridorScene, IsTwentyMetresLongAndHoldsThreeWraps) {
  const Scene scene = make_scene("corridor");
  EXPECT_NEAR(bounds(scene.surface).sizes().maxCoeff(), 20, 0.5);
  const Simulator simulator(scene, options_of(1));
  const ImageF first = simulator.simulate(0).range_truth_m;
  EXPECT_GT(largest(first), 3 * wavelength_a_m);
  EXPECT_FALSE(first.isNaN().any()) << "a gap in the walls";
}

TEST(RoomScene, IsAClosedLoopOf150FramesOrMoreThroughTwelveByNineMetres) {
  const Scene scene = make_scene("room");
  const Eigen::Vector3d size = bounds(scene.surface).sizes();
  EXPECT_NEAR(size.x(), 12, 0.2);
  EXPECT_NEAR(size.y(), 9, 0.2);
  const Simulator simulator(scene, options_of(1));
  EXPECT_GE(*simulator.frame_count(), 150);
  const Pose& first = simulator.trajectory().front().world_from_camera;
  const Pose& last = simulator.trajectory().back().world_from_camera;
  EXPECT_LT((first.translation() - last.translation()).norm(), 0.1);
  EXPECT_LT(rotation_angle_rad(first, last), 0.1);
}

TEST(FlatScene, IsAClosedLoopOf300FramesOrMoreThroughSeveralRooms) {
  const Simulator simulator(make_scene("flat"), options_of(1));
  EXPECT_GE(*simulator.frame_count(), 300);
  const Trajectory& poses = simulator.trajectory();
  const Eigen::Vector3d first = poses.front().world_from_camera.translation();
  EXPECT_LT((first - poses.back().world_from_camera.translation()).norm(), 0.1);
  // From a quarter of the way on, the start is hidden behind a wall.
  const Eigen::Vector3d away = poses[poses.size() / 2].world_from_camera.translation() - first;
  EXPECT_TRUE(simulator.rays().cast(first, away.normalized(), away.norm()));
}

TEST(PassageScene, HoldsBrightWallsCloseByBeforeDarkOnesFarAway) {
  SimulatorOptions options = options_of(1);
  options.width_px = 88;
  options.height_px = 72;
  const Simulator simulator(make_scene("passage"), options);
  ASSERT_GE(*simulator.frame_count(), 120);
  ASSERT_LE(*simulator.frame_count(), 200);
  int both = 0;
  for (int i = 0; i < *simulator.frame_count(); ++i) {
    const SimulatedFrame simulated = simulator.simulate(i);
    const ImageF& range_m = simulated.range_truth_m;
    const ImageF& amplitude = simulated.frame.amplitudes[0];
    const auto is_bright = range_m < 0.4F && amplitude > 10000;
    const auto is_dark = range_m > 15 && amplitude < 5;
    if (is_bright.any() && is_dark.count() > range_m.size() / 100) ++both;
  }
  EXPECT_GE(both, 30) << "ten at each of three jambs";
}

TEST(Scenes, UnknownOnesAreRefusedWithTheNamesOfTheOthers) {
  try {
    find_scene("ballroom");
    FAIL() << "found";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("ballroom"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("corridor"), std::string::npos);
  }
  EXPECT_THROW(find_scene("missing.ply"), InputError);
}

double smallest_clearance_m(const Simulator& simulator) {
  double smallest_m = 10;
  for (const StampedPose& pose : simulator.trajectory()) {
    smallest_m = std::min(smallest_m,
                          simulator.rays().clearance_m(pose.world_from_camera.translation(), 10));
  }
  return smallest_m;
}

TEST(MeshScene, OfARoomIsWalkedThroughInsideAndClearOfSurfaces) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "flat.ply";
  write_mesh_ply(file, make_scene("flat").surface);
  const Simulator simulator(find_scene(file.string()), options_of(1));
  EXPECT_GE(smallest_clearance_m(simulator), 0.3);
  for (const StampedPose& pose : simulator.trajectory()) {
    EXPECT_TRUE(bounds(simulator.surface()).contains(pose.world_from_camera.translation()));
  }
  EXPECT_FALSE(simulator.simulate(0).range_truth_m.isNaN().any());
}

TEST(MeshScene, OfAnObjectIsOrbited) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "box.ply";
  TriangleMesh mesh;
  add_box(mesh, {1, 1, 0}, {1.4, 1.5, 0.6}, 0.5);
  write_mesh_ply(file, mesh);
  const Simulator simulator(find_scene(file.string()), options_of(1));
  EXPECT_GE(smallest_clearance_m(simulator), 0.3);
  for (const ImageF& range_m : sampled_truth(simulator, 5)) {
    EXPECT_FALSE(std::isnan(range_m(72, 88))) << "the camera does not look at the object";
  }
}

TEST(MeshScene, OfTheBookstoreIsWalkedThrough) {
  const std::filesystem::path file =
      std::filesystem::path(TOFMAP_SHARED_DIR) / "data/meshes/bookstore.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const Simulator simulator(find_scene(file.string()), options_of(1));
  EXPECT_GE(smallest_clearance_m(simulator), 0.3);
  EXPECT_GE(*simulator.frame_count(), 100);
  for (const ImageF& range_m : sampled_truth(simulator, 5)) {
    EXPECT_LT(range_m.isNaN().count(), range_m.size() / 4);
  }
}

}  // namespace
}  // namespace tofmap
