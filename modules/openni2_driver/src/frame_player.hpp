// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "device_uri.hpp"

#include <functional>
#include <memory>
#include <optional>

#include <tofmap/acquisition/frame_source.hpp>

namespace tofmap {

/// Plays the frames of a scene or recording as often as requested. Timestamps continue to increase
/// when the frames begin again. Damaged frames are left out.
class FramePlayer {
 public:
  /// `keep_going` is called from several threads while a frame is simulated; when it returns false,
  /// no more frames follow. Throws UsageError or InputError if the scene or recording does not
  /// exist.
  FramePlayer(const DeviceRequest& request, std::function<bool()> keep_going);

  const SensorModel& sensor() const { return source_->sensor(); }

  /// Time between two frames; the median for a recording.
  double period_s() const { return period_s_; }

  /// The next frame; the timestamp of the first one is 0. Empty when all frames have been played or
  /// `keep_going` has returned false.
  std::optional<Frame> next();

 private:
  void open();

  DeviceRequest request_;
  std::function<bool()> keep_going_;
  std::unique_ptr<FrameSource> source_;
  double period_s_ = 0;
  int rounds_ = 0;
  int played_ = 0;  ///< frames played in this round
  std::optional<double> first_s_;
  double round_start_s_ = 0;
  double last_s_ = 0;
};

}  // namespace tofmap
