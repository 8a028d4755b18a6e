// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/watched_source.hpp"
#include "options/options.hpp"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/acquisition/openni2_source.hpp>
#include <tofmap/acquisition/queued_source.hpp>

namespace tofmap::app {

/// An OpenNI2 device or .oni file as a command uses it: frames arrive in a thread of their own, and
/// wait in a queue. Ctrl-C ends it.
class LiveInput {
 public:
  /// What a command wants beyond the options.
  struct Wanted {
    std::filesystem::path oni_file = {};  ///< where to record it; empty: nowhere
    int most_frames = 0;                  ///< 0: all
  };

  /// Opens it, as the options say. Throws as OpenNi2Source does.
  LiveInput(const std::string& uri, const ProgramOptions& options, const Wanted& wanted);

  FrameSource& frames() { return watched_; }
  const SensorModel& sensor() const { return source_.sensor(); }

  /// Frames that came too late or not whole, for a line of status; empty if there are none.
  std::string losses() const;

  /// The same in full, for a report, and why it ended.
  nlohmann::ordered_json report();

  /// What its first frames are doubted for: whether A and B belong together (docs/cameras.md).
  std::vector<std::string> warnings(const CameraErrors* camera = nullptr) {
    return watched_.warnings(camera);
  }

  /// If the device fell silent, a message that says so; else empty.
  std::string silence() const;

 private:
  std::string uri_;
  double timeout_s_;
  OpenNi2Source source_;
  QueuedSource queue_;
  WatchedSource watched_;
};

}  // namespace tofmap::app
