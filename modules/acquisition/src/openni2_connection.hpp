// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <OpenNI.h>

#include <tofmap/acquisition/frame_pairing.hpp>

namespace tofmap {

/// An image as OpenNI2 hands it over.
struct RawImage {
  DeviceStream stream = DeviceStream::range;
  std::int64_t timestamp_us = 0;
  double unit_m = 0;  ///< of range images
  ImageU16 pixels;
};

/// An open device whose depth and infrared streams run, and the recorder of them if there is one.
class OpenNi2Connection {
 public:
  /// Throws InputError that names the URI and what OpenNI2 says.
  OpenNi2Connection(const std::string& uri, const std::filesystem::path& oni_file);
  OpenNi2Connection(const OpenNi2Connection&) = delete;
  OpenNi2Connection& operator=(const OpenNi2Connection&) = delete;
  ~OpenNi2Connection();

  /// The next image of either stream; nothing if none came in that time.
  std::optional<RawImage> wait_for_image(int timeout_ms);

  bool has_amplitude() const { return infrared_.isValid(); }
  bool is_unplugged() const { return listener_.is_unplugged; }
  bool is_at_end() const { return listener_.is_at_end; }
  double horizontal_fov_rad() const { return depth_.getHorizontalFieldOfView(); }
  double frame_rate_hz() const { return depth_.getVideoMode().getFps(); }

  /// Whether an image is made when somebody waits for it.
  bool waits_for_reader() const;

  /// A property of the device that is a double; nothing if it has none of that number.
  std::optional<double> number(int property) const;

 private:
  /// OpenNI2 as long as somebody needs it, with a device and its streams.
  struct Opened {
    Opened();
    ~Opened();

    openni::Device device;
    openni::VideoStream depth;
    openni::VideoStream infrared;
  };

  /// Hears of devices as long as it lives.
  struct Listener : openni::OpenNI::DeviceDisconnectedListener,
                    openni::OpenNI::DeviceStateChangedListener {
    Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener();
    void onDeviceDisconnected(const openni::DeviceInfo* device) override;
    void onDeviceStateChanged(const openni::DeviceInfo* device, openni::DeviceState state) override;

    std::string uri;
    std::atomic<bool> is_unplugged = false;
    std::atomic<bool> is_at_end = false;
  };

  void open(const std::string& uri);
  void start(openni::VideoStream& stream, openni::SensorType type, const std::string& uri);
  void record(const std::filesystem::path& oni_file);
  void end_recording();
  RawImage read(DeviceStream stream);

  bool is_file_ = false;      ///< an .oni file
  bool tells_reads_ = false;  ///< the device waits for what is read
  std::unique_ptr<Opened> opened_ = std::make_unique<Opened>();
  Listener listener_;  ///< after OpenNI2 has begun
  openni::Device& device_ = opened_->device;
  openni::VideoStream& depth_ = opened_->depth;
  openni::VideoStream& infrared_ = opened_->infrared;
  openni::Recorder recorder_;
  std::filesystem::path oni_file_;
};

}  // namespace tofmap
