// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <tofmap/acquisition/kinect2/p0_tables.hpp>
#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap::kinect2 {

/// Writes a recording directory of version 2, which open_recording() reads.
///
/// P0 tables and manifest.json are written first, and every packet is listed after it was written,
/// so that the directory is a readable recording after any interruption. recording.complete is
/// written by finish(). Programs that are strict, such as libfreenect2's replay, refuse a directory
/// without it.
class RecordingWriter {
 public:
  /// Creates the folder, which must be new or empty. `camera` is the infrared camera, for images
  /// whose columns are as a Kinect sends them (mirror.hpp). `serial` names the device; it must not
  /// be empty.
  ///
  /// Throws UsageError if the camera does not have 512 x 424 pixels or a possible focal length, or
  /// the serial is empty, and InputError if the camera is not valid or the folder or a file cannot
  /// be written.
  RecordingWriter(std::filesystem::path folder, const CameraModel& camera, const P0Tables& p0,
                  const std::string& serial);

  /// Writes one packet. The time is rounded to the 0.125 ms of a Kinect's clock.
  ///
  /// Throws UsageError unless the time is at least 0, later than that of the packet before and
  /// less than 3 days after it, images have 512 x 424 pixels and finish() was not called. Throws
  /// InputError, which names the file, if a file cannot be written.
  void add(const Measurements& measurements, double timestamp_s);

  /// Marks the recording as complete. Does nothing the second time. Throws InputError if the file
  /// cannot be written.
  void finish();

  /// Number of packets written.
  int count() const { return count_; }

 private:
  std::filesystem::path folder_;
  std::ofstream journal_;
  std::optional<std::uint64_t> first_ticks_;
  std::uint64_t last_ticks_ = 0;
  int count_ = 0;
};

}  // namespace tofmap::kinect2
