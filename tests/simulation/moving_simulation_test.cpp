// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"
#include "support/sample_frames.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <omp.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// An ideal camera with one person ahead of it.
SimulatorOptions with_person(int frames) {
  SimulatorOptions options = test::ideal_camera();
  options.people = 1;
  options.frames = frames;
  return options;
}

/// A camera that stands still, 4 m in front of a wall. There is no floor: people walk 1.5 m below
/// the camera.
Scene still_scene() { return test::facing_wall_scene(4, 0.5); }

double moving_share(const SimulatedFrame& simulated) {
  return (simulated.moving > 0).cast<double>().mean();
}

TEST(MovingSimulation, TruthSaysWhereAPersonIsInFrontOfTheScene) {
  const Simulator simulator(still_scene(), with_person(10));
  SimulatorOptions options = with_person(10);
  options.people = 0;
  const Simulator empty(still_scene(), options);
  for (const int frame : {0, 9}) {
    const SimulatedFrame simulated = simulator.simulate(frame);
    const SimulatedFrame wall = empty.simulate(frame);
    EXPECT_EQ(wall.moving.size(), 0);
    EXPECT_GT(moving_share(simulated), 0.05);
    for (Eigen::Index i = 0; i < simulated.moving.size(); ++i) {
      const bool is_nearer =
          simulated.range_truth_m.data()[i] < wall.range_truth_m.data()[i] - 0.1F;
      ASSERT_EQ(simulated.moving.data()[i], is_nearer ? 255 : 0) << i;
    }
  }
}

TEST(MovingSimulation, PixelsThatSeeNobodyAreWhatTheyWere) {
  SimulatorOptions options;  // with noise, mixed pixels and a delay of B
  options.frames = 40;
  const Simulator empty(make_scene("room"), options);
  options.people = 2;
  const Simulator simulator(make_scene("room"), options);
  const Frame before = empty.simulate(20).frame;
  const SimulatedFrame after = simulator.simulate(20);
  int same_a = 0;
  int same_b = 0;
  for (Eigen::Index i = 0; i < after.moving.size(); ++i) {
    same_a += after.frame.phases[0].data()[i] == before.phases[0].data()[i] ? 1 : 0;
    same_b += after.frame.phases[1].data()[i] == before.phases[1].data()[i] ? 1 : 0;
  }
  const auto still = static_cast<int>((after.moving == 0).count());
  ASSERT_LT(still, after.moving.size());
  // The others are at the edges of the people.
  EXPECT_LE(same_a, still);
  EXPECT_GT(same_a, 0.95 * still);
  EXPECT_GT(same_b, 0.95 * still);
}

TEST(MovingSimulation, OnePersonCoversAFewTenthsOfThePicture) {
  for (const char* scene : {"flat", "room", "hall"}) {
    const Simulator simulator(make_scene(scene), with_person(0));
    double sum = 0;
    int frames = 0;
    for (int i = 0; i < *simulator.frame_count(); i += 10, ++frames) {
      sum += moving_share(simulator.simulate(i));
    }
    EXPECT_GT(sum / frames, 0.08) << scene;
    EXPECT_LT(sum / frames, 0.2) << scene;
  }
}

TEST(MovingSimulation, PeopleNearTheCameraCoverAThirdOfThePicture) {
  for (const char* scene : {"flat", "room", "hall"}) {
    SimulatorOptions options = with_person(0);
    options.people = 2;
    options.people_range_m = 1;
    const Simulator simulator(make_scene(scene), options);
    double sum = 0;
    int frames = 0;
    for (int i = 0; i < *simulator.frame_count(); i += 10, ++frames) {
      sum += moving_share(simulator.simulate(i));
    }
    EXPECT_GT(sum / frames, 0.27) << scene;
    EXPECT_LT(sum / frames, 0.42) << scene;
  }
}

TEST(MovingSimulation, PeopleMoveBetweenAAndB) {
  SimulatorOptions options = with_person(8);
  options.b_delay_share = 1;
  const Simulator simulator(still_scene(), options);
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(1);
  const SimulatedFrame now = simulator.simulate(3);
  const SimulatedFrame next = simulator.simulate(4);
  ASSERT_FALSE((now.moving == next.moving).all());
  // The camera stands still: B sees what the next frame sees at A. Rays are in single precision.
  constexpr double tolerance_m = 5e-5;
  EXPECT_LT(
      test::range_error_m(now.frame.phases[1], next.range_truth_m, wavelength_m).abs().maxCoeff(),
      tolerance_m);
  EXPECT_GT(
      test::range_error_m(now.frame.phases[1], now.range_truth_m, wavelength_m).abs().maxCoeff(),
      0.1);
}

TEST(MovingSimulation, PeopleMoveDuringAnExposure) {
  SimulatorOptions options = with_person(8);
  options.exposure_share = 1;
  const Simulator simulator(still_scene(), options);
  const SimulatedFrame blurred = simulator.simulate(3);
  const ImageF error_m = test::range_error_m(blurred.frame.phases[0], blurred.range_truth_m,
                                             simulator.sensor().modulation.wavelength_m(0))
                             .abs();
  // The wall stands still, and so does the camera; the person does not.
  const auto wrong = (error_m > 1e-3F).count();
  EXPECT_GT(wrong, 10);
  EXPECT_LT(wrong, error_m.size() / 4);
}

TEST(MovingSimulation, SameOptionsGiveTheSameBitsForAnyNumberOfThreadsAndOrderOfFrames) {
  SimulatorOptions options;
  options.frames = 3;
  options.people = 3;
  options.people_paths = PeoplePaths::both;
  options.doors = 2;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const SimulatedFrame one = Simulator(make_scene("hall"), options).simulate(2);
  omp_set_num_threads(4);
  const Simulator simulator(make_scene("hall"), options);
  static_cast<void>(simulator.simulate(1));
  const SimulatedFrame four = simulator.simulate(2);
  omp_set_num_threads(threads);
  EXPECT_GT(moving_share(one), 0);
  EXPECT_TRUE((one.moving == four.moving).all());
  EXPECT_TRUE(same_values(one.frame.phases[0], four.frame.phases[0]));
  EXPECT_TRUE(same_values(one.frame.phases[1], four.frame.phases[1]));
  EXPECT_TRUE(same_values(one.frame.amplitudes[1], four.frame.amplitudes[1]));
  EXPECT_TRUE(same_values(one.range_truth_m, four.range_truth_m));
}

TEST(MovingSimulation, SeedDrawsOtherPeople) {
  SimulatorOptions options = with_person(5);
  const SimulatedFrame one = Simulator(still_scene(), options).simulate(0);
  options.seed = 2;
  const SimulatedFrame other = Simulator(still_scene(), options).simulate(0);
  EXPECT_FALSE((one.moving == other.moving).all());
}

TEST(MovingSimulation, MultipathLightComesFromPeopleToo) {
  SimulatorOptions options = with_person(5);
  options.multipath_rays = 64;
  const SimulatedFrame with = Simulator(make_scene("wall"), options).simulate(0);
  options.people = 0;
  const SimulatedFrame without = Simulator(make_scene("wall"), options).simulate(0);
  // Floor and walls nearer than the person see the side that the camera lights, and those behind
  // lose light.
  int changed = 0;
  for (Eigen::Index i = 0; i < with.moving.size(); ++i) {
    const bool is_still = with.moving.data()[i] == 0;
    const bool has_changed =
        with.frame.amplitudes[0].data()[i] != without.frame.amplitudes[0].data()[i];
    changed += is_still && has_changed ? 1 : 0;
  }
  EXPECT_GT(changed, with.moving.size() / 4);
}

TEST(MovingSimulation, SequenceHoldsWhatMovesOnlyIfSomethingDoes) {
  const test::TemporaryFolder folder;
  const Simulator simulator(still_scene(), with_person(2));
  ASSERT_EQ(simulate_sequence(simulator, folder.path() / "with"), 2);
  const ImageU8 read = read_png_8(folder.path() / "with/moving_truth/000001.png");
  EXPECT_TRUE((read == simulator.simulate(1).moving).all());
  SimulatorOptions options = with_person(2);
  options.people = 0;
  ASSERT_EQ(simulate_sequence(Simulator(still_scene(), options), folder.path() / "without"), 2);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "without/moving_truth"));
}

TEST(MovingSimulation, ThingsMoveInMeshFilesAndOnTrajectoryFilesToo) {
  const test::TemporaryFolder folder;
  const auto mesh = folder.path() / "room.ply";
  write_mesh_ply(mesh, make_scene("room").surface);
  SimulatorOptions options = with_person(30);
  options.doors = 1;
  const Simulator in_mesh(find_scene(mesh.string()), options);
  EXPECT_EQ(in_mesh.bodies().doors().size(), 1U);
  EXPECT_EQ(in_mesh.bodies().people_at(1).size(), 1U);
  EXPECT_GT(moving_share(in_mesh.simulate(15)), 0.03);

  const auto poses = folder.path() / "poses.txt";
  write_trajectory(poses, in_mesh.trajectory());
  options.trajectory_file = poses.string();
  const Simulator on_path(make_scene("room"), options);
  EXPECT_EQ(on_path.bodies().doors().size(), 1U);
  EXPECT_GT(moving_share(on_path.simulate(15)), 0.03);
}

TEST(MovingSimulation, SurfaceHoldsFramesOfDoorsButNoLeaves) {
  SimulatorOptions options = test::ideal_camera();
  const std::size_t plain = Simulator(make_scene("room"), options).surface().triangles.size();
  options.doors = 2;
  const Simulator simulator(make_scene("room"), options);
  ASSERT_EQ(simulator.bodies().doors().size(), 2U);
  // Three bars of twelve triangles each.
  EXPECT_EQ(simulator.surface().triangles.size(), plain + 2 * 36);
}

TEST(MovingSimulation, RefusesOptionsThatAreNotAllowed) {
  const auto refused = [](const char* name, const auto& change) {
    SimulatorOptions options = test::ideal_camera();
    change(options);
    try {
      const Simulator simulator(still_scene(), options);
      ADD_FAILURE() << name << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused("people", [](SimulatorOptions& o) { o.people = 9; });
  refused("people", [](SimulatorOptions& o) { o.people = -1; });
  refused("people_range_m", [](SimulatorOptions& o) { o.people_range_m = 0.5; });
  refused("people_range_m", [](SimulatorOptions& o) { o.people_range_m = std::nan(""); });
  refused("doors", [](SimulatorOptions& o) { o.doors = 9; });
}

}  // namespace
}  // namespace tofmap
