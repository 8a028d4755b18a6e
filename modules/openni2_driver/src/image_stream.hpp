// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oni_driver_api.hpp"

#include <functional>
#include <mutex>
#include <vector>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// The properties that a stream reports to OpenNI2.
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

  /// Passes an image to OpenNI2 if the stream is running. The image must have the size of the mode.
  /// After stop() has returned, no delivery is in progress, unless OpenNI2 blocks it for more than
  /// a second.
  void deliver(const ImageU16& image, std::uint64_t timestamp_us, int index);

 private:
  StreamDescription description_;
  std::function<void()> on_change_;
  std::timed_mutex delivery_;  ///< held while OpenNI2 takes an image
  mutable std::mutex mutex_;   ///< guards the members below
  OniVideoMode mode_;
  bool is_running_ = false;
};

}  // namespace tofmap
