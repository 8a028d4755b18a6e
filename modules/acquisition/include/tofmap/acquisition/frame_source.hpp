// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// What a source delivers for one instant: a frame, or why there is none.
struct SourcedFrame {
  int index = 0;                            ///< counts all frames from 0, damaged ones too
  double timestamp_s = 0;                   ///< of image A
  std::optional<DualFrequencyFrame> frame;  ///< empty if the frame is damaged
  std::string damage;  ///< names the file and what is wrong; empty if the frame is whole
};

/// The seam to the hardware: whatever delivers dual-frequency frames in the order of time.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  virtual const SensorModel& sensor() const = 0;

  /// The next frame, or nothing at the end of the recording. A damaged frame is returned as
  /// such, so that it can be counted and skipped; throws InputError only where no further
  /// frame can come.
  virtual std::optional<SourcedFrame> next() = 0;

  /// How many frames there are in all, damaged ones included; nothing for a live source.
  virtual std::optional<int> frame_count() const = 0;
};

}  // namespace tofmap
