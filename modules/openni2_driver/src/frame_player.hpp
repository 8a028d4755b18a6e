// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "device_uri.hpp"

#include <functional>
#include <memory>
#include <optional>

#include <tofmap/acquisition/frame_source.hpp>

namespace tofmap {

/// The frames of a scene or recording, played as often as asked for: numbers and timestamps go on
/// where they begin again. Damaged frames are left out.
class FramePlayer {
 public:
  /// `keep_going` is asked while a frame is made, from several threads; once it says no, there are
  /// no more. Throws UsageError or InputError if there is no such scene or recording.
  FramePlayer(const DeviceRequest& request, std::function<bool()> keep_going);

  const SensorModel& sensor() const { return source_->sensor(); }

  /// Between two frames, seconds; of a recording the median.
  double period_s() const { return period_s_; }

  /// The next frame, timestamps from 0 on; nothing when all have been played, or it is not to keep
  /// going.
  std::optional<DualFrequencyFrame> next();

 private:
  void open();

  DeviceRequest request_;
  std::function<bool()> keep_going_;
  std::unique_ptr<FrameSource> source_;
  double period_s_ = 0;
  int rounds_ = 0;
  int played_ = 0;  ///< frames of this round
  std::optional<double> first_s_;
  double round_start_s_ = 0;
  double last_s_ = 0;
};

}  // namespace tofmap
