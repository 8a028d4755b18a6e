// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame_player.hpp"
#include "image_stream.hpp"
#include "oni_driver_api.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <tofmap/acquisition/device_image.hpp>

namespace tofmap {

/// An OpenNI2 device that plays frames in its own thread while at least one of its streams runs.
class PlayedDevice final : public oni::driver::DeviceBase {
 public:
  /// Notifications from the device to the driver, called from the device's thread.
  struct Events {
    std::function<void()> at_end;
    std::function<void()> unplugged;
    std::function<void(const char* what)> failed;
  };

  /// Throws UsageError or InputError if the requested scene or recording cannot be played.
  PlayedDevice(const DeviceRequest& request, Events events);
  ~PlayedDevice() override;

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
  oni::driver::StreamBase* createStream(OniSensorType type) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniBool isPropertySupported(int id) override;
  OniStatus invoke(int id, void* data, int size) override;
  OniBool isCommandSupported(int id) override;
  OniStatus tryManualTrigger() override;

 private:
  using Clock = std::chrono::steady_clock;

  /// A timestamp and the time at which it was due. The due times of later timestamps follow from
  /// it.
  struct Beginning {
    Clock::time_point moment;
    double timestamp_s;
  };

  using Streams = std::vector<std::shared_ptr<ImageStream>>;

  void play();
  bool wait_for_stream();
  void let_start();
  bool wait_for_turn(double timestamp_s);
  void deliver(const Frame& frame);
  void deliver_images(const ImageU16& range, const ImageU16& amplitude, double timestamp_s);
  void deliver_image(ImageStream& stream, const ImageU16& image, std::uint64_t timestamp_us);
  const DeviceImageCodec& codec();
  Streams streams();
  bool has_running_stream();
  bool is_asked_for();
  bool is_ending();
  void update(const std::function<void()>& change);

  DeviceRequest request_;
  Events events_;
  FramePlayer player_;
  std::vector<DeviceImageCodec> codecs_;  ///< one for each mode of the depth stream
  StreamDescription depth_;
  StreamDescription infrared_;
  std::vector<OniSensorInfo> sensors_;

  std::mutex streams_mutex_;
  Streams streams_;

  std::mutex mutex_;  ///< guards the members down to is_closing_
  std::condition_variable changed_;
  double speed_;
  bool is_starting_ = true;             ///< no stream was running, so let_start() must wait
  std::optional<Beginning> beginning_;  ///< empty after the speed has changed
  bool is_triggered_ = false;           ///< a client is waiting for an image
  bool hears_of_reads_ = false;         ///< a client has set the property images_read
  int unread_ = 0;                      ///< delivered images that no client has reported as read
  Clock::time_point delivered_;         ///< time of the last delivery
  bool is_unplugged_ = false;
  bool is_closing_ = false;

  std::atomic<int> frames_ = 0;  ///< frames played
  int images_ = 0;               ///< images of one stream; used by thread_ only
  std::thread thread_;           ///< declared last, because it uses all other members
};

}  // namespace tofmap
