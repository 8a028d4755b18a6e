// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The embedded recording gives what it gave before. Where a change makes results better,
// datasets/small_room/expected is made anew (its card says how).

#include <gtest/gtest.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::test {
namespace {

const std::filesystem::path data = std::filesystem::path(TOFMAP_SOURCE_DIR) / "datasets/small_room";

/// Other processors round the last bits of a float otherwise, and one pixel in a thousand may hang
/// on those.
constexpr double rounded_otherwise = 0.001;

TEST(EmbeddedRecording, IsUnwrappedAsBefore) {
  const SequenceReader recording(data / "recording");
  for (int i = 0; i < recording.frame_count(); ++i) {
    const SourcedFrame frame = recording.read(i);
    ASSERT_TRUE(frame.frame) << frame.damage;
    const ImageU8 counts = unwrap(*frame.frame, recording.sensor(), {}).image.wrap_count;
    const auto name = recording.files()[static_cast<std::size_t>(i)].phases[0].filename();
    const ImageU8 expected = read_png_8(data / "expected/wraps" / name);
    EXPECT_LE((counts != expected).count(), rounded_otherwise * static_cast<double>(counts.size()))
        << name;
    EXPECT_GT((expected == 1).count(), 0) << name << " has nothing to unwrap";
  }
}

TEST(EmbeddedRecording, IsMappedAsBefore) {
  SequenceReader recording(data / "recording");
  const RoomMap map = map_room(recording, {});
  const Trajectory expected = read_trajectory(data / "expected/trajectory.txt");
  ASSERT_EQ(map.trajectory.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // A few pixels that count otherwise move a pose by far less than its error of 1 mm.
    EXPECT_LT((map.trajectory[i].world_from_camera.translation() -
               expected[i].world_from_camera.translation())
                  .norm(),
              2e-4)
        << "pose " << i;
  }
}

TEST(EmbeddedRecording, IsSimulatedAsBefore) {
  const SequenceReader recording(data / "recording");
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.frames = 8;
  const Simulator simulator(make_scene("room"), options);
  for (int i = 0; i < recording.frame_count(); ++i) {
    const Frame expected = *recording.read(i).frame;
    const Frame frame = simulator.simulate(i).frame;
    const ImageF difference = (frame.phases[0] - expected.phases[0]).abs();
    // Files hold phases in steps of 1/65535 cycle.
    const auto off =
        (difference > 2.0F / 65535 || frame.phases[0].isNaN() != expected.phases[0].isNaN());
    EXPECT_LE(off.count(), rounded_otherwise * static_cast<double>(difference.size()));
  }
}

}  // namespace
}  // namespace tofmap::test
