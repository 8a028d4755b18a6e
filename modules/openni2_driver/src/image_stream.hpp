// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oni_driver_api.hpp"

#include <functional>
#include <mutex>
#include <vector>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// What a stream answers when it is asked.
struct StreamDescription {
  OniSensorType type = ONI_SENSOR_DEPTH;
  std::vector<OniVideoMode> modes;
  float horizontal_fov_rad = 0;
  float vertical_fov_rad = 0;
};

/// The depth or infrared stream of a device.
class ImageStream final : public oni::driver::StreamBase {
 public:
  /// `on_change` is called when the stream starts or stops.
  ImageStream(StreamDescription description, std::function<void()> on_change);

  OniStatus start() override;
  void stop() override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniBool isPropertySupported(int id) override;

  OniSensorType type() const { return description_.type; }
  bool is_running() const;
  OniVideoMode mode() const;

  /// Hands an image to OpenNI2, if the stream runs. It must be of the size of the mode. When stop()
  /// has returned, none is on its way, unless OpenNI2 itself held it up.
  void deliver(const ImageU16& image, std::uint64_t timestamp_us, int index);

 private:
  StreamDescription description_;
  std::function<void()> on_change_;
  std::timed_mutex delivery_;  ///< held while OpenNI2 takes an image
  mutable std::mutex mutex_;   ///< of what follows
  OniVideoMode mode_;
  bool is_running_ = false;
};

}  // namespace tofmap
