// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What becomes of the scene is tested in tests/simulation/kinect2_recording_test.cpp.

#include "support/kinect2_samples.hpp"

#include <filesystem>
#include <optional>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/acquisition/kinect2/intrinsics.hpp>
#include <tofmap/acquisition/kinect2/kinect2_source.hpp>
#include <tofmap/acquisition/kinect2/phases.hpp>
#include <tofmap/acquisition/kinect2/recording_writer.hpp>

namespace tofmap {
namespace {

class Kinect2Frames : public testing::Test {
 protected:
  /// Opens a recording of two packets.
  Kinect2Source source(const kinect2::Measurements& first) const {
    const std::filesystem::path recording = folder_.path() / "recording";
    kinect2::RecordingWriter writer(recording, kinect2::camera_of(kinect2::typical_intrinsics),
                                    test::sample_p0_tables(), "1");
    writer.add(first, 1);
    writer.add(test::sample_measurements(1), 2);
    return Kinect2Source(kinect2::open_recording(recording));
  }

  test::TemporaryFolder folder_;
};

TEST_F(Kinect2Frames, HaveTheCameraOfImagesThatAreMirroredBack) {
  const SensorModel sensor = source(test::sample_measurements()).sensor();
  EXPECT_NEAR(sensor.camera.cx_px, 511.5 - kinect2::typical_intrinsics.cx, 1e-9);
  EXPECT_NEAR(sensor.camera.cy_px, kinect2::typical_intrinsics.cy - 0.5, 1e-9);
  EXPECT_EQ(sensor.modulation, (Modulation{80e6, 16e6, 120e6}));
}

TEST_F(Kinect2Frames, AreDamagedOneByOneIfPacketsCannotBeRead) {
  Kinect2Source frames = source(test::sample_measurements());
  const std::filesystem::path packet = frames.recording().packets[0].file;
  std::filesystem::resize_file(packet, 100);
  const std::optional<SourcedFrame> first = frames.next();
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->frame);
  test::expect_part(first->damage, packet.string());
  const std::optional<SourcedFrame> second = frames.next();
  ASSERT_TRUE(second && second->frame);
  EXPECT_EQ(second->index, 1);
  EXPECT_EQ(second->frame->index, 1);
  EXPECT_EQ(second->timestamp_s, 2);
  EXPECT_FALSE(frames.next());
}

TEST_F(Kinect2Frames, AreSaturatedAtTheFrequencyWhereAStepIs) {
  kinect2::Measurements measured = test::sample_measurements();
  measured.steps[2][1](100, 10) = 32767;
  Kinect2Source frames = source(measured);
  const Frame frame = *frames.next()->frame;
  EXPECT_EQ(frame.amplitudes[2](100, 501), frames.sensor().saturation_amplitude);
  EXPECT_EQ(frame.phases[2](100, 501), 0);
  EXPECT_LT(frame.amplitudes[0](100, 501), frames.sensor().saturation_amplitude);
  EXPECT_EQ((frame.amplitudes[2] >= kinect2::saturated_amplitude).count(), 1);
}

TEST_F(Kinect2Frames, WithTheLargestMeasurementsAreNotSaturated) {
  kinect2::Measurements measured = test::sample_measurements();
  const int magnitudes[] = {16320, -16320, -16320};
  for (int k = 0; k < 3; ++k) {
    measured.steps[1][k](50, 60) = static_cast<std::int16_t>(magnitudes[k]);
  }
  Kinect2Source frames = source(measured);
  EXPECT_NEAR(frames.next()->frame->amplitudes[1](50, 451), 65280, 0.1);
}

}  // namespace
}  // namespace tofmap
