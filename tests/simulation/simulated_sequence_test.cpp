// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"
#include "support/sample_frames.hpp"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

SimulatorOptions small_options() {
  SimulatorOptions options;
  options.width_px = 44;
  options.height_px = 36;
  options.frames = 4;
  return options;
}

/// No value lies farther from its place on the 16-bit grid than rounding puts it, and the
/// same pixels are NaN.
void expect_close(const ImageF& read, const ImageF& written, double tolerance) {
  ASSERT_TRUE(same_size(read, written));
  for (Eigen::Index i = 0; i < read.size(); ++i) {
    const float a = read.data()[i];
    const float b = written.data()[i];
    ASSERT_EQ(std::isnan(a), std::isnan(b)) << i;
    if (!std::isnan(a)) {
      ASSERT_NEAR(a, b, tolerance) << i;
    }
  }
}

TEST(SimulatedSequence, ReadsBackAsItWasSimulated) {
  const test::TemporaryFolder folder;
  const Simulator simulator(make_scene("flat"), small_options());
  EXPECT_EQ(simulate_sequence(simulator, folder.path() / "seq"), 4);
  const SequenceReader reader(folder.path() / "seq");
  ASSERT_EQ(reader.frame_count(), 4);
  EXPECT_EQ(reader.sensor().max_range_m, simulator.sensor().max_range_m);
  const Trajectory poses = reader.ground_truth();
  ASSERT_EQ(poses.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const SimulatedFrame expected = simulator.simulate(i);
    const SourcedFrame read = reader.read(i);
    ASSERT_TRUE(read.frame) << read.damage;
    const double half_step = 0.5000001 / 65535;
    // On the circle: the last half step before a whole cycle is written as zero.
    ImageF phase = read.frame->phases[0];
    phase = (expected.frame.phases[0] - phase > 0.5F).select(phase + 1, phase);
    expect_close(phase, expected.frame.phases[0], half_step + 1e-7);
    expect_close(read.frame->amplitudes[1], expected.frame.amplitudes[1], 0.5);
    expect_close(*reader.range_truth(i), expected.range_truth_m, 0.000501);
    EXPECT_TRUE(poses[i].world_from_camera.isApprox(expected.world_from_camera, 1e-8));
  }
}

TEST(SimulatedSequence, HoldsTheSurface) {
  const test::TemporaryFolder folder;
  const Simulator simulator(make_scene("slope"), small_options());
  simulate_sequence(simulator, folder.path() / "seq");
  const TriangleMesh read = read_mesh(folder.path() / "seq/scene.ply");
  ASSERT_EQ(read.vertices.size(), simulator.surface().vertices.size());
  EXPECT_EQ(read.triangles, simulator.surface().triangles);
  for (std::size_t i = 0; i < read.vertices.size(); ++i) {
    ASSERT_EQ(read.vertices[i], simulator.surface().vertices[i]);
    ASSERT_NEAR(read.reflectance[i], simulator.surface().reflectance[i], 0.5001 / 255);
  }
}

TEST(SimulatedSequence, ThatIsInterruptedKeepsWhatWasFinished) {
  const test::TemporaryFolder folder;
  const Simulator simulator(make_scene("wall"), small_options());
  const auto stop_after_two = [](int done, int total) {
    EXPECT_EQ(total, 4);
    return done < 2;
  };
  EXPECT_EQ(simulate_sequence(simulator, folder.path() / "seq", stop_after_two), 2);
  const SequenceReader reader(folder.path() / "seq");
  EXPECT_EQ(reader.frame_count(), 2);
  EXPECT_EQ(reader.ground_truth().size(), 2U);
  EXPECT_TRUE(reader.read(1).frame) << reader.read(1).damage;
}

TEST(SimulatedSequence, NeedsAFolderOfItsOwn) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "letter.txt") << "mine\n";
  const Simulator simulator(make_scene("wall"), small_options());
  EXPECT_THROW(simulate_sequence(simulator, folder.path()), InputError);
}

}  // namespace
}  // namespace tofmap
