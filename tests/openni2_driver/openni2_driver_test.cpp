// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include <OpenNI.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/openni2_properties.hpp>

namespace tofmap {
namespace {

constexpr const char* small_room =
    "tofmap://room?speed=-1&simulator.width_px=64&simulator.height_px=48&simulator.subpixels=1";

/// A device that is opened by OpenNI2's own means.
class Driver : public testing::Test {
 protected:
  Driver() { EXPECT_EQ(openni::OpenNI::initialize(), openni::STATUS_OK); }
  ~Driver() override {
    device_.close();
    openni::OpenNI::shutdown();
  }

  void open(const std::string& uri) {
    ASSERT_EQ(device_.open(uri.c_str()), openni::STATUS_OK) << openni::OpenNI::getExtendedError();
  }

  static bool wait_for(openni::VideoStream& stream, openni::VideoFrameRef& frame) {
    openni::VideoStream* streams[] = {&stream};
    int ready = -1;
    constexpr int timeout_ms = 5000;
    return openni::OpenNI::waitForAnyStream(streams, 1, &ready, timeout_ms) == openni::STATUS_OK &&
           stream.readFrame(&frame) == openni::STATUS_OK;
  }

  openni::Device device_;
};

TEST_F(Driver, TellsWhatTheDeviceIs) {
  open(small_room);
  EXPECT_STREQ(device_.getDeviceInfo().getVendor(), "tofmap");
  EXPECT_TRUE(device_.hasSensor(openni::SENSOR_DEPTH));
  EXPECT_TRUE(device_.hasSensor(openni::SENSOR_IR));
  EXPECT_FALSE(device_.hasSensor(openni::SENSOR_COLOR));
  double frequency_hz = 0;
  EXPECT_EQ(device_.getProperty(openni2_property::frequency_a_hz, &frequency_hz),
            openni::STATUS_OK);
  EXPECT_EQ(frequency_hz, 29e6);
  EXPECT_EQ(device_.getProperty(openni2_property::frequency_b_hz, &frequency_hz),
            openni::STATUS_OK);
  EXPECT_EQ(frequency_hz, 31e6);
  EXPECT_FALSE(device_.isPropertySupported(openni2_property::vendor + 99));
}

TEST_F(Driver, DeliversDepthAndInfraredAtOneFieldOfView) {
  open(small_room);
  for (const openni::SensorType type : {openni::SENSOR_DEPTH, openni::SENSOR_IR}) {
    openni::VideoStream stream;
    ASSERT_EQ(stream.create(device_, type), openni::STATUS_OK);
    EXPECT_NEAR(stream.getHorizontalFieldOfView(), 69 * M_PI / 180, 1e-3);
    ASSERT_EQ(stream.start(), openni::STATUS_OK);
    openni::VideoFrameRef frame;
    ASSERT_TRUE(wait_for(stream, frame));
    EXPECT_EQ(frame.getWidth(), 64);
    EXPECT_GT(frame.getHeight(), 2 * 48);
    EXPECT_EQ(frame.getDataSize(), 2 * frame.getWidth() * frame.getHeight());
    stream.stop();
    stream.destroy();
  }
}

TEST_F(Driver, OffersDepthInTwoUnits) {
  open(small_room);
  openni::VideoStream depth;
  ASSERT_EQ(depth.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  openni::VideoMode mode = depth.getVideoMode();
  EXPECT_EQ(mode.getPixelFormat(), openni::PIXEL_FORMAT_DEPTH_100_UM);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  openni::VideoFrameRef fine;
  ASSERT_TRUE(wait_for(depth, fine));
  const auto steps = static_cast<const std::uint16_t*>(fine.getData())[32];
  depth.stop();
  mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
  ASSERT_EQ(depth.setVideoMode(mode), openni::STATUS_OK);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  openni::VideoFrameRef coarse;
  ASSERT_TRUE(wait_for(depth, coarse));
  EXPECT_NEAR(static_cast<const std::uint16_t*>(coarse.getData())[32], steps / 10, 100)
      << "the next frame, from nearly the same place";
  mode.setResolution(640, 480);
  EXPECT_NE(depth.setVideoMode(mode), openni::STATUS_OK);
  depth.stop();
  depth.destroy();
}

TEST_F(Driver, ServesSeveralClients) {
  open(small_room);
  openni::Device other;
  ASSERT_EQ(other.open(small_room), openni::STATUS_OK);
  openni::VideoStream one;
  openni::VideoStream two;
  ASSERT_EQ(one.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(two.create(other, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(one.start(), openni::STATUS_OK);
  ASSERT_EQ(two.start(), openni::STATUS_OK);
  openni::VideoFrameRef frame;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(wait_for(one, frame));
    EXPECT_TRUE(wait_for(two, frame));
  }
  one.stop();
  one.destroy();
  EXPECT_TRUE(wait_for(two, frame)) << "the other goes on";
  two.stop();
  two.destroy();
  other.close();
}

TEST_F(Driver, DeliversWhileStreamsComeAndGo) {
  open(
      "tofmap://wall?speed=0&repeat=0&simulator.width_px=16&simulator.height_px=16"
      "&simulator.subpixels=1&simulator.frames=2");
  openni::VideoStream depth;
  ASSERT_EQ(depth.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  openni::VideoFrameRef frame;
  ASSERT_TRUE(wait_for(depth, frame));
  for (int i = 0; i < 300; ++i) {
    openni::VideoStream infrared;
    ASSERT_EQ(infrared.create(device_, openni::SENSOR_IR), openni::STATUS_OK);
    ASSERT_EQ(infrared.start(), openni::STATUS_OK);
    infrared.stop();
    infrared.destroy();
  }
  EXPECT_TRUE(wait_for(depth, frame));
  depth.stop();
  depth.destroy();
}

TEST_F(Driver, WaitsForAClientThatTellsWhatItHasRead) {
  open(small_room);
  openni::VideoStream depth;
  openni::VideoStream infrared;
  ASSERT_EQ(depth.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(infrared.create(device_, openni::SENSOR_IR), openni::STATUS_OK);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  ASSERT_EQ(infrared.start(), openni::STATUS_OK);
  openni::VideoFrameRef depth_frame;
  openni::VideoFrameRef infrared_frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(wait_for(depth, depth_frame));
    device_.setProperty(openni2_property::images_read, 1);
    // Asks for more before it has read the other image, for longer than clients may that do not
    // tell.
    openni::VideoStream* streams[] = {&depth};
    int ready = -1;
    EXPECT_EQ(openni::OpenNI::waitForAnyStream(streams, 1, &ready, 100), openni::STATUS_TIME_OUT);
    ASSERT_TRUE(wait_for(infrared, infrared_frame));
    device_.setProperty(openni2_property::images_read, 1);
    EXPECT_EQ(infrared_frame.getTimestamp(), depth_frame.getTimestamp());
  }
  for (openni::VideoStream* stream : {&depth, &infrared}) {
    stream->stop();
    stream->destroy();
  }
}

TEST_F(Driver, ChangesItsSpeedOnTheWay) {
  open(small_room);
  float speed = 0;
  EXPECT_EQ(device_.getProperty(openni::DEVICE_PROPERTY_PLAYBACK_SPEED, &speed), openni::STATUS_OK);
  EXPECT_EQ(speed, -1);
  EXPECT_NE(device_.setProperty(openni::DEVICE_PROPERTY_PLAYBACK_SPEED, -3.0F), openni::STATUS_OK);
  EXPECT_EQ(device_.setProperty(openni::DEVICE_PROPERTY_PLAYBACK_SPEED, 0.0F), openni::STATUS_OK);
  openni::VideoStream depth;
  ASSERT_EQ(depth.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  // Nobody asks, and frames come all the same.
  int frames = 0;
  for (int i = 0; i < 200 && frames < 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    device_.getProperty(openni2_property::frames_delivered, &frames);
  }
  EXPECT_GE(frames, 5);
  depth.stop();
  depth.destroy();
}

struct Unplugged : openni::OpenNI::DeviceDisconnectedListener {
  void onDeviceDisconnected(const openni::DeviceInfo* /*device*/) override { has_come = true; }
  std::atomic<bool> has_come = false;
};

TEST_F(Driver, IsUnpluggedOnCommand) {
  open(small_room);
  Unplugged unplugged;
  openni::OpenNI::addDeviceDisconnectedListener(&unplugged);
  openni::VideoStream depth;
  ASSERT_EQ(depth.create(device_, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(depth.start(), openni::STATUS_OK);
  EXPECT_EQ(device_.invoke(openni2_property::unplug, nullptr, 0), openni::STATUS_OK);
  for (int i = 0; i < 200 && !unplugged.has_come; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }
  EXPECT_TRUE(unplugged.has_come);
  openni::OpenNI::removeDeviceDisconnectedListener(&unplugged);
  depth.stop();
  depth.destroy();
}

}  // namespace
}  // namespace tofmap
