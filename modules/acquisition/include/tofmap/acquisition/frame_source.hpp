// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// What a source delivers for one instant: a frame, or the reason why the frame is damaged.
struct SourcedFrame {
  int index = 0;               ///< counts all frames from 0, including damaged ones
  double timestamp_s = 0;      ///< time of the first image
  std::optional<Frame> frame;  ///< empty if the frame is damaged
  std::string damage;  ///< names the file and what is wrong; empty if the frame is not damaged
};

/// The interface of everything that delivers frames in the order of time:
/// recordings, devices and the simulator.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// The sensor that took the frames. It stays the same over all frames.
  virtual const SensorModel& sensor() const = 0;

  /// The next frame. Empty at the end of the source. A damaged frame is returned with the reason,
  /// so that the caller can count and skip it. Throws InputError only if no further frame can
  /// follow.
  virtual std::optional<SourcedFrame> next() = 0;

  /// Total number of frames, including damaged ones. Empty if it is unknown, as for live sources.
  virtual std::optional<int> frame_count() const = 0;
};

}  // namespace tofmap
