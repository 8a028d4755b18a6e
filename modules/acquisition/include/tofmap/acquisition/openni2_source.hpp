// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/device_options.hpp>
#include <tofmap/acquisition/frame_pairing.hpp>
#include <tofmap/acquisition/frame_source.hpp>

namespace tofmap {

/// True if the text names a device or an .oni file rather than a folder: it contains "://" or ends
/// in ".oni".
bool is_device_uri(const std::string& text);

/// An OpenNI2 device or an .oni file as a source of frames.
///
/// The source joins images of the same instant to frames; it drops and counts images that it cannot
/// join. An .oni file is read as fast as the caller asks for frames. A device delivers at its own
/// rate and keeps only the latest image, so call next() from a thread of its own (QueuedSource).
/// .oni files stay open until the program ends and hold some hundred kilobytes each, because
/// OpenNI2's player occasionally crashes when it is closed.
class OpenNi2Source final : public FrameSource {
 public:
  struct Settings {
    DeviceOptions options = {};
    CameraCalibration calibration = {};
    /// .oni file to which the images of the device are recorded. Empty: no recording.
    std::filesystem::path oni_file = {};
    int most_frames = 0;  ///< the source ends after this number of frames; 0: no limit
    /// Called several times a second while the source waits for images. The source ends when it
    /// returns false. May be empty.
    std::function<bool()> keep_going = {};
  };

  /// Opens the device and waits for its first images, which show what the device delivers. Throws
  /// InputError, which names the URI and the remedy, if the device cannot be opened, delivers no
  /// range image within the time limit, or does not fit the options. Throws UsageError if the
  /// options lack something that the device does not say.
  OpenNi2Source(const std::string& uri, Settings settings);
  ~OpenNi2Source() override;

  const SensorModel& sensor() const override;

  /// The next complete frame. Empty when the source has ended; end() has the reason. The indices
  /// count the returned frames. Throws InputError if images arrive, but none of them make a frame.
  std::optional<SourcedFrame> next() override;

  /// Always empty: the number is not known in advance.
  std::optional<int> frame_count() const override { return std::nullopt; }

  /// Why the source has ended.
  enum class End : std::uint8_t {
    none,          ///< the source has not ended
    of_recording,  ///< the file has no more frames
    unplugged,     ///< the device was unplugged
    timeout,       ///< no image arrived within the time limit
    asked,         ///< Settings::keep_going returned false, or Settings::most_frames were delivered
  };
  End end() const;

  /// True if the source makes each frame when it is asked for, as files do, so that none is missed.
  bool waits_for_reader() const;

  /// What became of the images so far. May be called from another thread.
  PairingCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tofmap
