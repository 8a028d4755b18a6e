// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <tofmap/acquisition/camera_calibration.hpp>
#include <tofmap/acquisition/frame_pairing.hpp>
#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/core/option_table.hpp>

namespace tofmap {

/// How a device delivers dual-frequency frames (docs/cameras.md). Images that carry a tag, as those
/// of tofmap's own devices, say it themselves; the rest is for others.
struct DeviceOptions {
  std::string layout = "auto";
  double frequency_a_hz = 0;
  double frequency_b_hz = 0;
  std::string depth = "z";
  double max_range_m = 0;
  std::string first = "auto";
  double period_s = 0;
  double timeout_s = 5;

  static std::vector<OptionField<DeviceOptions>> fields();
};

/// Whether the text names a device or .oni file instead of a folder: it has a scheme ("://") or
/// that ending.
bool is_device_uri(const std::string& text);

/// An OpenNI2 device, or an .oni file, as a source of dual-frequency frames.
///
/// Frames are made of the images that belong together; what does not is dropped and counted. An
/// .oni file is read as fast as frames are asked for, a device as it delivers: ask from a thread of
/// its own (QueuedSource), since it keeps only the latest image. Files stay open until the program
/// ends, some hundred kilobytes each: OpenNI2's player crashes now and then when it is closed.
class OpenNi2Source final : public FrameSource {
 public:
  struct Settings {
    DeviceOptions options = {};
    CameraCalibration calibration = {};
    /// Where to record what the device delivers; empty: nowhere.
    std::filesystem::path oni_file = {};
    int most_frames = 0;  ///< it ends after so many; 0: it does not
    /// Asked several times a second while waiting for images; false ends the source.
    std::function<bool()> keep_going = {};
  };

  /// Opens the device and waits for its first images, which tell what it delivers. Throws
  /// InputError that names the URI and the remedy if it cannot be opened, delivers no range images,
  /// nothing at all within the time limit, or not what the options say; UsageError if the options
  /// leave open what must be known.
  OpenNi2Source(const std::string& uri, Settings settings);
  ~OpenNi2Source() override;

  const SensorModel& sensor() const override;

  /// The next whole frame; nothing when the source has ended, for which end() has the reason.
  /// Indices count the frames returned.
  std::optional<SourcedFrame> next() override;

  /// Not known in advance.
  std::optional<int> frame_count() const override { return std::nullopt; }

  enum class End : std::uint8_t {
    none,          ///< it goes on
    of_recording,  ///< the file has no more frames
    unplugged,
    timeout,  ///< no image came within the time limit
    asked,    ///< keep_going said no, or there are enough frames
  };
  End end() const;

  /// Whether frames come when they are asked for, as from files, and none is missed.
  bool waits_for_reader() const;

  /// What became of the images so far. May be asked from another thread.
  PairingCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tofmap
