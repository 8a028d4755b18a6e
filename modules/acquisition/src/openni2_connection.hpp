// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <OpenNI.h>

#include <tofmap/acquisition/frame_pairing.hpp>

namespace tofmap {

/// An image as OpenNI2 delivers it.
struct RawImage {
  DeviceStream stream = DeviceStream::range;
  std::int64_t timestamp_us = 0;
  double unit_m = 0;  ///< metres per step of range images; 0 for infrared images
  ImageU16 pixels;
};

/// An open device with running depth and infrared streams, and the recorder of these streams if
/// they are recorded.
class OpenNi2Connection {
 public:
  /// Opens the device and starts its streams. Records them to `oni_file` unless it is empty. Throws
  /// InputError with the URI and OpenNI2's message if that fails, and UsageError if the URI is one
  /// of tofmap's and asks for something that is not allowed.
  OpenNi2Connection(const std::string& uri, const std::filesystem::path& oni_file);
  OpenNi2Connection(const OpenNi2Connection&) = delete;
  OpenNi2Connection& operator=(const OpenNi2Connection&) = delete;
  ~OpenNi2Connection();

  /// The next image of either stream. Empty if no image arrives within the time.
  std::optional<RawImage> wait_for_image(int timeout_ms);

  bool has_amplitude() const { return infrared_.isValid(); }
  bool is_unplugged() const { return listener_.is_unplugged; }
  bool is_at_end() const { return listener_.is_at_end; }
  double horizontal_fov_rad() const { return depth_.getHorizontalFieldOfView(); }
  double frame_rate_hz() const { return depth_.getVideoMode().getFps(); }

  /// True if the device makes an image only when a client waits for one.
  bool waits_for_reader() const;

  /// The modulation frequencies that the device reports, in the order of its images. Empty if it
  /// reports none.
  std::vector<double> frequencies_hz() const;

 private:
  /// Keeps OpenNI2 initialised, with a device and its streams.
  struct Opened {
    Opened();
    ~Opened();

    openni::Device device;
    openni::VideoStream depth;
    openni::VideoStream infrared;
  };

  /// Receives OpenNI2's notifications about devices during its lifetime.
  struct Listener : openni::OpenNI::DeviceDisconnectedListener,
                    openni::OpenNI::DeviceStateChangedListener {
    Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() override;
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

  bool is_file_ = false;      ///< the device is an .oni file
  bool tells_reads_ = false;  ///< the device is told of each image that was read
  std::unique_ptr<Opened> opened_ = std::make_unique<Opened>();
  Listener listener_;  ///< declared after `opened_`, which initialises OpenNI2
  openni::Device& device_ = opened_->device;
  openni::VideoStream& depth_ = opened_->depth;
  openni::VideoStream& infrared_ = opened_->infrared;
  openni::Recorder recorder_;
  std::filesystem::path oni_file_;
};

}  // namespace tofmap
